#include "messages.h"

#include <bit>
#include <cassert>
#include <cstring>

namespace plisse::studio {

namespace {

constexpr std::size_t header_bytes = 24;

/// Fills a message of known length with little-endian numbers.
class MessageWriter {
public:
    explicit MessageWriter(std::size_t bytes) : bytes_(bytes) {}

    void header(std::uint32_t kind, std::uint32_t level, std::uint32_t version, std::size_t vertices, double t) {
        u32(kind);
        u32(level);
        u32(version);
        u32(vertices);
        put(std::bit_cast<std::uint64_t>(t));
    }
    template <typename Integer>
    void u32(Integer value) {
        put(static_cast<std::uint32_t>(value));
    }
    void f32(double value) { put(std::bit_cast<std::uint32_t>(static_cast<float>(value))); }

    Bytes finish() {
        assert(position_ == bytes_.size());
        return std::move(bytes_);
    }

private:
    template <typename Unsigned>
    void put(Unsigned value) {
        assert(position_ + sizeof value <= bytes_.size());
        // Compilers make one store of it.
        for (std::size_t i = 0; i < sizeof value; ++i)
            bytes_[position_ + i] = static_cast<unsigned char>(value >> (8 * i));
        position_ += sizeof value;
    }

    Bytes bytes_;
    std::size_t position_ = 0;
};

} // namespace

Bytes encode_mesh(const MeshMessage& mesh) {
    assert(mesh.parts.size() == mesh.faces.size());
    assert(mesh.unusable || mesh.marked.empty());
    const std::size_t marks = mesh.unusable ? 4 + 4 * mesh.marked.size() : 0;
    MessageWriter writer(header_bytes + 8 + 16 * mesh.faces.size() + marks);
    writer.header(1, mesh.level, mesh.version, mesh.vertices, mesh.t);
    writer.u32(mesh.faces.size());
    writer.u32(mesh.unusable ? 1 : 0);
    for (const Face& face : mesh.faces)
        for (const int vertex : face)
            writer.u32(vertex);
    for (const int part : mesh.parts)
        writer.u32(part);
    if (mesh.unusable) {
        writer.u32(mesh.marked.size());
        for (const int face : mesh.marked)
            writer.u32(face);
    }
    return writer.finish();
}

Bytes encode_positions(const PositionsMessage& message, const ConstPositions& positions, const ShownScalars* scalars) {
    const auto vertices = static_cast<std::size_t>(positions.cols());
    assert(!scalars || scalars->values.size() == vertices);
    MessageWriter writer(header_bytes + 8 + 12 * vertices + (scalars ? 8 + 4 * vertices : 0));
    writer.header(2, message.level, message.version, vertices, message.t);
    writer.u32((scalars ? 1 : 0) | (message.saved_frame ? 2 : 0) | (message.prolonged ? 4 : 0));
    writer.u32(message.step);
    for (const auto point : positions.colwise())
        for (const double coordinate : point)
            writer.f32(coordinate);
    if (scalars) {
        writer.f32(scalars->low);
        writer.f32(scalars->high);
        for (const double value : scalars->values)
            writer.f32(value);
    }
    return writer.finish();
}

} // namespace plisse::studio
