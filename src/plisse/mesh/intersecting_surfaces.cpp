#include <plisse/mesh/intersecting_surfaces.h>

#include <set>

#include <plisse/spatial/box.h>

namespace plisse {

IntersectingSurfaces::IntersectingSurfaces(const InputError& error, const Positions& x, std::span<const Face> faces,
                                           std::span<const std::array<int, 2>> pairs, std::span<const int> face_part)
    : InputError(error) {
    std::set<int> meeting;
    for (const auto& pair : pairs)
        meeting.insert(pair.begin(), pair.end());
    faces_.positions.resize(3, 3 * static_cast<int>(meeting.size()));
    for (int f : meeting) {
        const int first = 3 * faces_.face_count();
        for (int k = 0; k < 3; ++k)
            faces_.positions.col(first + k) = x.col(faces[static_cast<std::size_t>(f)][static_cast<std::size_t>(k)]);
        faces_.faces.push_back({first, first + 1, first + 2});
        parts_.push_back(face_part[static_cast<std::size_t>(f)]);
    }
}

Vec3 meeting_place(const Positions& x, const Face& a, const Face& b) {
    Box box_a, box_b;
    for (std::size_t k = 0; k < 3; ++k) {
        box_a.include(x.col(a[k]));
        box_b.include(x.col(b[k]));
    }
    return 0.5 * (box_a.low.cwiseMax(box_b.low) + box_a.high.cwiseMin(box_b.high));
}

} // namespace plisse
