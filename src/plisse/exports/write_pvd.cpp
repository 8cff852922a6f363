#include <plisse/exports/write_pvd.h>

#include <plisse/exports/numbered_files.h>
#include <plisse/exports/text_output.h>
#include <plisse/exports/unfinished_files.h>
#include <plisse/exports/write_vtp.h>
#include <plisse/exports/xml_text.h>

namespace plisse {

std::filesystem::path pvd_folder(const std::filesystem::path& path) {
    return std::filesystem::path(path).replace_extension();
}

void write_pvd(const std::filesystem::path& path, const Animation& animation) {
    const std::filesystem::path folder = pvd_folder(path);
    const std::string name = folder.filename().string();
    expect_own_folder(folder, name, ".vtp");
    UnfinishedFiles unfinished;
    const std::filesystem::path unfinished_folder = unfinished.add_folder(folder);
    OutputFile file(unfinished.add_file(path));

    std::string out = "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" "
                      "byte_order=\"LittleEndian\">\n  <Collection>\n";
    for (std::size_t k = 0; k < animation.size(); ++k) {
        const std::string state_file = numbered_file(name, k, ".vtp");
        write_vtp(unfinished_folder / state_file, animation.state(k), animation.face_part, animation.times[k]);
        put_text(out, "    <DataSet timestep=\"{}\" part=\"0\" file=\"{}\"/>\n", animation.times[k],
                 xml_escaped(name + "/" + state_file));
    }
    file.write(out + "  </Collection>\n</VTKFile>\n");
    file.close();
    unfinished.finish();
}

} // namespace plisse
