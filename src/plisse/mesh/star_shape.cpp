#include <plisse/mesh/shapes.h>

#include <plisse/mesh/portable_math.h>

namespace plisse {

namespace {

/// A solid star prism whose top is turned against its bottom: PSQ figure 20. Every horizontal section is the star
/// outline, turned and shrunk as straight edges between the outlines make it, so it never meets itself below half a
/// turn.
class StarBuilder {
public:
    explicit StarBuilder(const GeneratorOptions& options)
        : options_(options), sides_(2 * options.points), regular_(options.pattern == Pattern::regular) {
        const CosSin twist = cos_sin_turns(options.twist_deg / 720); // half of it at each end
        half_twist_ = {twist.cos, twist.sin};
        for (int i = 0; i < sides_; ++i) {
            const CosSin turn = cos_sin_turns(static_cast<double>(i) / sides_);
            const double radius = i % 2 == 0 ? options.radius : options.radius * (1 - options.depth);
            corners_.emplace_back(radius * turn.cos, -radius * turn.sin);
        }
        side_length_ = std::sqrt(dot2(corners_[1] - corners_[0], corners_[1] - corners_[0]));
    }

    Shape build() {
        const double half = options_.height / 2;
        const Section top = add_section(half, 1, true);
        const Section bottom = add_section(-half, 1, true);
        add_cap(top, half, false);
        add_walls(top, bottom);
        add_cap(bottom, -half, true);
        return {std::move(mesh_), projection()};
    }

private:
    using Chain = std::vector<int>;
    using Section = std::vector<Chain>; ///< a chain from corner to corner for each side

    static double dot2(const Vec2& a, const Vec2& b) { return a.x() * b.x() + a.y() * b.y(); }
    int top_patch() const { return sides_; }
    int bottom_patch() const { return sides_ + 1; }

    /// The similarity that takes the outline to its section at height y, as a complex number: the mean of the two ends'
    /// rotations, weighted by height.
    Vec2 similarity(double y) const {
        const double share = y / options_.height; // -1/2 .. 1/2
        return {half_twist_.x(), 2 * share * half_twist_.y()};
    }

    Vec3 corner(int i, double y, double scale) const {
        const Vec2 s = similarity(y);
        const Vec2& c = corners_[static_cast<std::size_t>(i % sides_)];
        return {scale * (c.x() * s.x() + c.y() * s.y()), y, scale * (c.y() * s.x() - c.x() * s.y())};
    }

    /// The outline at height y, shrunk. cut: its sides at edge length, else from corner to corner.
    Section add_section(double y, double scale, bool cut) {
        Chain corner_vertices;
        for (int i = 0; i < sides_; ++i)
            corner_vertices.push_back(mesh_.add_vertex(corner(i, y, scale), PatchMesh::fixed));
        const int count = cut ? divisions(scale * side_length_, options_.edge_length) : 1;
        Section section;
        for (int i = 0; i < sides_; ++i) {
            const int from = corner_vertices[static_cast<std::size_t>(i)];
            const int to = corner_vertices[static_cast<std::size_t>((i + 1) % sides_)];
            Chain chain = {from};
            const Chain inner = add_straight_points(mesh_, mesh_.point(from), mesh_.point(to), count);
            chain.insert(chain.end(), inner.begin(), inner.end());
            chain.push_back(to);
            section.push_back(chain);
        }
        return section;
    }

    /// patch -1: each side its own.
    void zip_sections(const Section& lower, const Section& upper, int patch) {
        for (std::size_t i = 0; i < lower.size(); ++i)
            mesh_.zip(lower[i], upper[i], patch < 0 ? static_cast<int>(i) : patch);
    }

    void add_walls(const Section& top, const Section& bottom) {
        const int rows =
            divisions(std::sqrt(options_.height * options_.height + drift_squared()), options_.edge_length);
        Section above = top;
        for (int k = 1; k < rows; ++k) {
            const Section section = add_section(options_.height * (rows - 2 * k) / (2.0 * rows), 1, regular_);
            zip_sections(section, above, -1);
            above = section;
        }
        zip_sections(bottom, above, -1);
    }

    /// Square of how far a tip of the top lies from its place on the bottom.
    double drift_squared() const {
        const double drift = 2 * options_.radius * half_twist_.y();
        return drift * drift;
    }

    void add_cap(const Section& outline, double y, bool is_bottom) {
        const int patch = is_bottom ? bottom_patch() : top_patch();
        const double inner_radius = options_.radius * (1 - options_.depth);
        const int rings = regular_ ? divisions(inner_radius, options_.edge_length) : 1;
        Section outer = outline;
        const auto zip_ring = [&](const Section& inner) {
            zip_sections(is_bottom ? inner : outer, is_bottom ? outer : inner, patch);
        };
        for (int k = rings - 1; k > 0; --k) {
            const Section inner = add_section(y, static_cast<double>(k) / rings, true);
            zip_ring(inner);
            outer = inner;
        }
        const Chain centre = {mesh_.add_vertex({0, y, 0}, patch)};
        zip_ring(Section(outline.size(), centre));
    }

    /// Horizontally onto the side's line in the section at the point's height.
    Projection projection() const {
        return [self = *this](int patch, const Vec3& p) {
            const double half = self.options_.height / 2;
            if (patch >= self.top_patch())
                return Vec3(p.x(), patch == self.top_patch() ? half : -half, p.z());
            const Vec3 a = self.corner(patch, p.y(), 1);
            const Vec3 side = self.corner(patch + 1, p.y(), 1) - a;
            const double t = dot(p - a, side) / dot(side, side);
            return Vec3(a.x() + t * side.x(), p.y(), a.z() + t * side.z());
        };
    }

    GeneratorOptions options_;
    int sides_;
    bool regular_;
    Vec2 half_twist_;
    std::vector<Vec2> corners_; ///< (x, z) of tips and notches in turn, untwisted
    double side_length_ = 0;
    PatchMesh mesh_;
};

} // namespace

Shape star(const GeneratorOptions& options) {
    return StarBuilder(options).build();
}

} // namespace plisse
