#include <plisse/exports/write_pc2.h>

#include <cstdint>

#include <plisse/exports/unfinished_files.h>
#include <plisse/exports/write_obj.h>
#include <plisse/mesh/binary_bytes.h>

namespace plisse {

namespace {

std::string header(int points, std::size_t samples) {
    std::string out("POINTCACHE2\0", 12);
    put_little_endian(out, std::int32_t{1}); // version
    put_little_endian(out, static_cast<std::int32_t>(points));
    put_little_endian(out, 0.0F); // first frame
    put_little_endian(out, 1.0F); // frames from sample to sample
    put_little_endian(out, static_cast<std::int32_t>(samples));
    return out;
}

std::string sample(const Positions& positions) {
    std::string out;
    for (double coordinate : positions.reshaped())
        put_little_endian(out, static_cast<float>(coordinate));
    return out;
}

} // namespace

std::filesystem::path pc2_mesh_file(const std::filesystem::path& path) {
    return std::filesystem::path(path).replace_extension(".obj");
}

void write_pc2(const std::filesystem::path& path, const Animation& animation) {
    UnfinishedFiles unfinished;
    const TriangleMesh first = animation.state(0);
    write_obj(unfinished.add_file(pc2_mesh_file(path)), first, animation.face_part, animation.parts);
    OutputFile file(unfinished.add_file(path));
    file.write(header(first.vertex_count(), animation.size()));
    for (std::size_t k = 0; k < animation.size(); ++k)
        file.write(sample(animation.state(k).positions));
    file.close();
    unfinished.finish();
}

} // namespace plisse
