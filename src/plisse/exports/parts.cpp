#include <plisse/exports/parts.h>

#include <algorithm>
#include <cassert>

namespace plisse {

namespace {

/// Told apart by hue and by lightness; the first few are what most scenes show.
constexpr std::array<std::array<float, 3>, 6> palette = {{{0.12F, 0.27F, 0.55F},
                                                          {0.45F, 0.43F, 0.40F},
                                                          {0.60F, 0.25F, 0.07F},
                                                          {0.10F, 0.38F, 0.20F},
                                                          {0.42F, 0.12F, 0.32F},
                                                          {0.58F, 0.48F, 0.12F}}};

/// The numbers that occur in the faces, ascending; the faces then hold places in that list.
std::vector<int> renumber(std::vector<Face>& faces) {
    std::vector<int> used;
    for (const Face& face : faces)
        used.insert(used.end(), face.begin(), face.end());
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    for (Face& face : faces)
        for (int& corner : face)
            corner = static_cast<int>(std::lower_bound(used.begin(), used.end(), corner) - used.begin());
    return used;
}

TextureMap texture_of(const TextureMap& whole, std::vector<Face> faces, const std::vector<int>& vertices) {
    TextureMap part;
    for (int point : renumber(faces)) {
        const auto p = static_cast<std::size_t>(point);
        part.points.push_back(whole.points[p]);
        const auto place = std::lower_bound(vertices.begin(), vertices.end(), whole.vertices[p]);
        part.vertices.push_back(static_cast<int>(place - vertices.begin()));
    }
    part.faces = std::move(faces);
    return part;
}

} // namespace

Eigen::Matrix3Xf PartMesh::points_of(const Positions& positions) const {
    return positions(Eigen::all, vertices).cast<float>();
}

std::vector<PartMesh> split_parts(const Animation& animation, const TriangleMesh& first) {
    assert(animation.face_part.size() == first.faces.size());
    const TextureMap texture = texture_map(first);
    std::vector<PartMesh> parts;
    for (std::size_t p = 0; p < animation.parts.size(); ++p) {
        PartMesh part{animation.parts[p], {}, {}, {}, palette[p % palette.size()]};
        std::vector<Face> texture_faces;
        for (std::size_t f = 0; f < first.faces.size(); ++f)
            if (animation.face_part[f] == static_cast<int>(p)) {
                part.faces.push_back(first.faces[f]);
                if (!texture.empty())
                    texture_faces.push_back(texture.faces[f]);
            }
        part.vertices = renumber(part.faces);
        part.texture = texture_of(texture, std::move(texture_faces), part.vertices);
        if (!part.faces.empty())
            parts.push_back(std::move(part));
    }
    return parts;
}

std::vector<bool> find_moving_parts(const Animation& animation, const std::vector<PartMesh>& parts) {
    std::vector<bool> moving(parts.size(), false);
    const Positions first = animation.state(0).positions;
    for (std::size_t k = 1; k < animation.size() && std::find(moving.begin(), moving.end(), false) != moving.end();
         ++k) {
        const Positions now = animation.state(k).positions;
        for (std::size_t p = 0; p < parts.size(); ++p)
            moving[p] = moving[p] || parts[p].points_of(now) != parts[p].points_of(first);
    }
    return moving;
}

} // namespace plisse
