#include <plisse/mesh/polygons.h>

#include <cassert>

namespace plisse {

void PolygonFan::add(std::span<const int> corners) {
    assert(corners.size() >= 3);
    for (std::size_t k = 1; k + 1 < corners.size(); ++k) {
        faces_.push_back({corners[0], corners[k], corners[k + 1]});
        polygon_.push_back(polygon_count_);
        const int second = corner_count_ + static_cast<int>(k);
        face_corners_.push_back({corner_count_, second, second + 1});
    }
    ++polygon_count_;
    corner_count_ += static_cast<int>(corners.size());
    larger_ += corners.size() > 3 ? 1 : 0;
}

MeshAttribute PolygonFan::face_attribute(std::string name, int width, std::span<const double> values) const {
    assert(values.size() == static_cast<std::size_t>(width) * static_cast<std::size_t>(polygon_count_));
    MeshAttribute attribute{std::move(name), MeshAttribute::Domain::face, width, {}};
    attribute.values.reserve(polygon_.size() * static_cast<std::size_t>(width));
    for (int polygon : polygon_) {
        const auto row = values.subspan(static_cast<std::size_t>(polygon) * static_cast<std::size_t>(width),
                                        static_cast<std::size_t>(width));
        attribute.values.insert(attribute.values.end(), row.begin(), row.end());
    }
    return attribute;
}

MeshAttribute PolygonFan::corner_attribute(std::string name, int width, std::span<const double> values) const {
    assert(values.size() == static_cast<std::size_t>(width) * static_cast<std::size_t>(corner_count_));
    MeshAttribute attribute{std::move(name), MeshAttribute::Domain::corner, width, {}};
    attribute.values.reserve(3 * face_corners_.size() * static_cast<std::size_t>(width));
    for (const Face& corners : face_corners_)
        for (int corner : corners) {
            const auto row = values.subspan(static_cast<std::size_t>(corner) * static_cast<std::size_t>(width),
                                            static_cast<std::size_t>(width));
            attribute.values.insert(attribute.values.end(), row.begin(), row.end());
        }
    return attribute;
}

void PolygonFan::add_note(std::vector<std::string>& notes) const {
    if (larger_ > 0)
        notes.push_back(std::to_string(larger_) + (larger_ == 1 ? " face" : " faces") +
                        " with more than three corners cut into triangles from the first corner");
}

} // namespace plisse
