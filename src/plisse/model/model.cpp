#include <plisse/model/model.h>

namespace plisse {

namespace {

template <typename RangeOf>
std::vector<int> numbered_parts(const Model& model, int count, const RangeOf& range_of) {
    std::vector<int> parts(static_cast<std::size_t>(count), -1);
    int number = 0;
    const auto fill = [&](const Range& range) {
        for (int i = range.begin; i < range.end; ++i)
            parts[static_cast<std::size_t>(i)] = number;
        ++number;
    };
    for (const Body& body : model.bodies)
        fill(range_of(body));
    for (const Obstacle& obstacle : model.obstacles)
        fill(range_of(obstacle));
    return parts;
}

} // namespace

std::vector<double> friction_coefficients(const ContactSettings& contact, int part_count) {
    const auto parts = static_cast<std::size_t>(part_count);
    std::vector<double> coefficients(parts * parts, contact.friction);
    const auto of = [&](int a, int b) -> double& {
        return coefficients[static_cast<std::size_t>(a) * parts + static_cast<std::size_t>(b)];
    };
    for (const ContactSettings::Pair& pair : contact.pairs)
        of(pair.a, pair.b) = of(pair.b, pair.a) = pair.friction;
    return coefficients;
}

std::vector<int> Model::vertex_parts() const {
    return numbered_parts(*this, mesh.vertex_count(), [](const auto& part) { return part.vertices; });
}

std::vector<int> Model::face_parts() const {
    return numbered_parts(*this, mesh.face_count(), [](const auto& part) { return part.faces; });
}

const std::string& Model::part_name(int part) const {
    const std::size_t number = static_cast<std::size_t>(part);
    return is_obstacle(part) ? obstacles[number - bodies.size()].name : bodies[number].name;
}

} // namespace plisse
