#include <plisse/decimate/level_attributes.h>

#include <algorithm>

#include <Eigen/QR>

namespace plisse {

namespace {

std::size_t at(int index) {
    return static_cast<std::size_t>(index);
}

/// Reads an attribute of the input's mesh anywhere on it.
class Sampler {
public:
    Sampler(const MeshAttribute& attribute, const std::vector<Face>& faces) : attribute_(attribute), faces_(faces) {}

    /// At a place of a face, whose corners have these elements' values.
    VecX at_place(const Anchor& anchor, const std::array<int, 3>& elements) const {
        if (attribute_.number != MeshAttribute::Number::real) {
            Eigen::Index nearest = 0;
            anchor.weights.maxCoeff(&nearest);
            return values(elements[at(static_cast<int>(nearest))]);
        }
        VecX sum = VecX::Zero(attribute_.width);
        for (int k = 0; k < 3; ++k)
            if (anchor.weights[k] != 0)
                sum += anchor.weights[k] * values(elements[at(k)]);
        return sum;
    }
    VecX values(int element) const {
        return Eigen::Map<const VecX>(attribute_.values.data() + at(element) * at(attribute_.width), attribute_.width);
    }
    std::array<int, 3> vertices(int face) const { return faces_[at(face)]; }
    static std::array<int, 3> corners(int face) { return {3 * face, 3 * face + 1, 3 * face + 2}; }

private:
    const MeshAttribute& attribute_;
    const std::vector<Face>& faces_;
};

/// The input's faces around each of its vertices.
std::vector<std::vector<int>> faces_around(const HierarchyLevel& input) {
    std::vector<std::vector<int>> around(at(static_cast<int>(input.rest.cols())));
    for (std::size_t f = 0; f < input.faces.size(); ++f)
        for (int v : input.faces[f])
            around[at(v)].push_back(static_cast<int>(f));
    return around;
}

/// One place as the faces that meet there see it: inside a face one, on an edge two, at a vertex all around it.
std::vector<Anchor> same_places(const Anchor& anchor, const std::vector<Face>& faces,
                                const std::vector<std::vector<int>>& around) {
    const Face& corners = faces[at(anchor.face)];
    Eigen::Index heaviest = 0;
    anchor.weights.maxCoeff(&heaviest);
    std::vector<Anchor> result;
    for (int f : around[at(corners[at(static_cast<int>(heaviest))])]) {
        Anchor other{f, Vec3::Zero()};
        double found = 0;
        for (std::size_t k = 0; k < 3; ++k)
            for (int c = 0; c < 3; ++c)
                if (faces[at(f)][at(c)] == corners[k]) {
                    other.weights[c] = anchor.weights[static_cast<Eigen::Index>(k)];
                    found += other.weights[c];
                }
        constexpr double round_off = 1e-9;
        if (found > 1 - round_off)
            result.push_back(other);
    }
    return result;
}

void append(std::vector<double>& values, const VecX& more) {
    values.insert(values.end(), more.begin(), more.end());
}

/// Weights of a face's corners, of any sign, for the point of its plane nearest to x.
Vec3 extended_weights(const Face& face, const Positions& rest, const Vec3& x) {
    Mat32 edges;
    edges << rest.col(face[1]) - rest.col(face[0]), rest.col(face[2]) - rest.col(face[0]);
    const Vec2 along = edges.colPivHouseholderQr().solve(x - rest.col(face[0]));
    return {1 - along.sum(), along[0], along[1]};
}

/// A vertex that no face uses has its own values.
void append_vertices(const Sampler& sampler, const HierarchyLevel& level, const HierarchyLevel& input,
                     std::vector<double>& values) {
    for (std::size_t v = 0; v < level.on_input.size(); ++v) {
        const Anchor& anchor = level.on_input[v];
        if (anchor.face >= 0) {
            append(values, sampler.at_place(anchor, sampler.vertices(anchor.face)));
            continue;
        }
        const auto own = std::lower_bound(input.vertex_ids.begin(), input.vertex_ids.end(), level.vertex_ids[v]);
        append(values, sampler.values(static_cast<int>(own - input.vertex_ids.begin())));
    }
}

/// A corner takes the values at its vertex's place: those on the side of the face's own face of the input where that
/// has the place, else of all sides that meet there those nearest to what the values on its own face extend to. Where
/// none is near, all of them are across a seam, and it takes the extended ones.
void append_corners(const Sampler& sampler, const HierarchyLevel& level, const HierarchyLevel& input,
                    std::vector<double>& values) {
    const auto around = faces_around(input);
    const auto value_at = [&](const Anchor& place) { return sampler.at_place(place, Sampler::corners(place.face)); };
    for (std::size_t f = 0; f < level.faces.size(); ++f) {
        const int own = level.face_ids[f];
        const VecX centre = value_at({own, Vec3::Constant(1.0 / 3)});
        for (int v : level.faces[f]) {
            const VecX extended =
                value_at({own, extended_weights(input.faces[at(own)], input.rest, level.rest.col(v))});
            VecX chosen = extended;
            double nearest = (extended - centre).norm(); // farther is across a seam
            for (const Anchor& place : same_places(level.on_input[at(v)], input.faces, around)) {
                const VecX candidate = value_at(place);
                if (place.face == own) {
                    chosen = candidate;
                    break;
                }
                if (const double distance = (candidate - extended).norm(); distance <= nearest) {
                    nearest = distance;
                    chosen = candidate;
                }
            }
            append(values, chosen);
        }
    }
}

} // namespace

std::vector<MeshAttribute> attributes_on(const Hierarchy& hierarchy, int level,
                                         const std::vector<MeshAttribute>& of_input) {
    const HierarchyLevel& mesh = hierarchy.levels[at(level)];
    const HierarchyLevel& input = hierarchy.levels[at(hierarchy.input_level())];
    if (level == hierarchy.input_level())
        return of_input;
    std::vector<MeshAttribute> result;
    for (const MeshAttribute& attribute : of_input) {
        const Sampler sampler(attribute, input.faces);
        MeshAttribute& on_level = result.emplace_back(attribute);
        on_level.values.clear();
        if (attribute.domain == MeshAttribute::Domain::vertex)
            append_vertices(sampler, mesh, input, on_level.values);
        else if (attribute.domain == MeshAttribute::Domain::face)
            for (int id : mesh.face_ids)
                append(on_level.values, sampler.values(id));
        else
            append_corners(sampler, mesh, input, on_level.values);
    }
    return result;
}

} // namespace plisse
