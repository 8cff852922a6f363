#include <plisse/exports/gltf_buffer.h>

#include <plisse/mesh/binary_bytes.h>

namespace plisse {

namespace {

// As the glTF 2.0 specification numbers them.
constexpr int component_uint32 = 5125, component_float = 5126;
constexpr int target_vertices = 34962, target_corners = 34963, no_target = 0;

std::string bytes_of(const float* values, std::size_t count) {
    std::string bytes;
    for (std::size_t i = 0; i < count; ++i)
        put_little_endian(bytes, values[i]);
    return bytes;
}

nlohmann::ordered_json numbers(const Eigen::Vector3f& vector) {
    return {vector.x(), vector.y(), vector.z()};
}

} // namespace

int GltfBuffer::add(const std::string& bytes, const char* type, int component_type, std::size_t count, int target) {
    const auto number = static_cast<int>(accessors_.size());
    nlohmann::ordered_json view = {{"buffer", 0}, {"byteOffset", size_}, {"byteLength", bytes.size()}};
    if (target != no_target)
        view["target"] = target;
    views_.push_back(std::move(view));
    accessors_.push_back({{"bufferView", number}, {"componentType", component_type}, {"count", count}, {"type", type}});
    file_.write(bytes);
    size_ += bytes.size();
    return number;
}

int GltfBuffer::add_vectors(const Eigen::Matrix3Xf& vectors) {
    const auto count = static_cast<std::size_t>(vectors.cols());
    return add(bytes_of(vectors.data(), 3 * count), "VEC3", component_float, count, target_vertices);
}

int GltfBuffer::add_positions(const Eigen::Matrix3Xf& points) {
    const int number = add_vectors(points);
    accessors_.back()["min"] = numbers(points.rowwise().minCoeff());
    accessors_.back()["max"] = numbers(points.rowwise().maxCoeff());
    return number;
}

int GltfBuffer::add_texture_points(std::span<const Vec2> points) {
    std::vector<float> values;
    for (const Vec2& point : points) {
        values.push_back(static_cast<float>(point.x()));
        values.push_back(static_cast<float>(1 - point.y()));
    }
    return add(bytes_of(values.data(), values.size()), "VEC2", component_float, points.size(), target_vertices);
}

int GltfBuffer::add_corners(std::span<const Face> faces) {
    std::string bytes;
    for (const Face& face : faces)
        for (int corner : face)
            put_little_endian(bytes, static_cast<std::uint32_t>(corner));
    return add(bytes, "SCALAR", component_uint32, 3 * faces.size(), target_corners);
}

int GltfBuffer::add_scalars(std::span<const float> values) {
    return add(bytes_of(values.data(), values.size()), "SCALAR", component_float, values.size(), no_target);
}

int GltfBuffer::add_times(std::span<const float> times) {
    const int number = add_scalars(times);
    accessors_.back()["min"] = {times.front()};
    accessors_.back()["max"] = {times.back()};
    return number;
}

} // namespace plisse
