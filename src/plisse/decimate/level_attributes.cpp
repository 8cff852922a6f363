#include <plisse/decimate/level_attributes.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

#include <Eigen/QR>

namespace plisse {

namespace {

std::size_t at(int index) {
    return static_cast<std::size_t>(index);
}

/// Reads an attribute of the finest mesh anywhere on it.
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

/// The finest faces around each finest vertex.
std::vector<std::vector<int>> faces_around(const HierarchyLevel& finest) {
    std::vector<std::vector<int>> around(at(static_cast<int>(finest.rest.cols())));
    for (std::size_t f = 0; f < finest.faces.size(); ++f)
        for (int v : finest.faces[f])
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

/// The finest faces in parts that seams divide: an edge is on a seam when its faces have unlike values at one of its
/// ends. One number a face.
std::vector<int> islands(const Sampler& sampler, const HierarchyLevel& finest) {
    std::vector<int> parent(finest.faces.size());
    std::iota(parent.begin(), parent.end(), 0);
    const auto root = [&](int f) {
        while (parent[at(f)] != f)
            f = parent[at(f)] = parent[at(parent[at(f)])];
        return f;
    };
    struct Side {
        int face;
        VecX values[2]; ///< at the edge's lower and upper vertex
    };
    std::map<std::pair<int, int>, std::vector<Side>> sides_of;
    for (std::size_t f = 0; f < finest.faces.size(); ++f)
        for (std::size_t k = 0; k < 3; ++k) {
            std::size_t low = k, high = (k + 1) % 3;
            if (finest.faces[f][low] > finest.faces[f][high])
                std::swap(low, high);
            const int corner = 3 * static_cast<int>(f);
            auto& sides = sides_of[{finest.faces[f][low], finest.faces[f][high]}];
            sides.push_back(
                {static_cast<int>(f),
                 {sampler.values(corner + static_cast<int>(low)), sampler.values(corner + static_cast<int>(high))}});
            for (const Side& other : sides)
                if (other.values[0] == sides.back().values[0] && other.values[1] == sides.back().values[1])
                    parent[at(root(other.face))] = root(static_cast<int>(f));
        }
    for (std::size_t f = 0; f < parent.size(); ++f)
        parent[f] = root(static_cast<int>(f));
    return parent;
}

/// Weights of a face's corners, of any sign, for the point of its plane nearest to x.
Vec3 extended_weights(const Face& face, const Positions& rest, const Vec3& x) {
    Mat32 edges;
    edges << rest.col(face[1]) - rest.col(face[0]), rest.col(face[2]) - rest.col(face[0]);
    const Vec2 along = edges.colPivHouseholderQr().solve(x - rest.col(face[0]));
    return {1 - along.sum(), along[0], along[1]};
}

/// A corner takes the values at its vertex's place where that is on the island of the face's own finest face, and
/// otherwise what that face's values extend to: no face spans a seam.
void append_corners(const Sampler& sampler, const HierarchyLevel& level, const HierarchyLevel& finest,
                    std::vector<double>& values) {
    const auto around = faces_around(finest);
    const std::vector<int> island = islands(sampler, finest);
    for (std::size_t f = 0; f < level.faces.size(); ++f) {
        const int own = level.face_ids[f];
        for (int v : level.faces[f]) {
            const auto places = same_places(level.on_finest[at(v)], finest.faces, around);
            const auto place = std::find_if(places.begin(), places.end(), [&](const Anchor& anchor) {
                return island[at(anchor.face)] == island[at(own)];
            });
            const Anchor extended{own, extended_weights(finest.faces[at(own)], finest.rest, level.rest.col(v))};
            const Anchor& seen = place == places.end() ? extended : *place;
            append(values, sampler.at_place(seen, Sampler::corners(seen.face)));
        }
    }
}

} // namespace

std::vector<MeshAttribute> attributes_on(const Hierarchy& hierarchy, int level,
                                         const std::vector<MeshAttribute>& finest) {
    const HierarchyLevel& coarse = hierarchy.levels[at(level)];
    if (level + 1 == hierarchy.level_count())
        return finest;
    std::vector<MeshAttribute> result;
    for (const MeshAttribute& attribute : finest) {
        const Sampler sampler(attribute, hierarchy.finest().faces);
        MeshAttribute& on_level = result.emplace_back(attribute);
        on_level.values.clear();
        if (attribute.domain == MeshAttribute::Domain::vertex)
            for (const Anchor& anchor : coarse.on_finest)
                append(on_level.values, sampler.at_place(anchor, sampler.vertices(anchor.face)));
        else if (attribute.domain == MeshAttribute::Domain::face)
            for (int id : coarse.face_ids)
                append(on_level.values, sampler.values(id));
        else
            append_corners(sampler, coarse, hierarchy.finest(), on_level.values);
    }
    return result;
}

} // namespace plisse
