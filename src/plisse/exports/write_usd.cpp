#include <plisse/exports/write_usd.h>

#include <cctype>
#include <set>
#include <vector>

#include <fmt/core.h>

#include <plisse/exports/parts.h>
#include <plisse/exports/playback.h>
#include <plisse/exports/text_output.h>
#include <plisse/exports/unfinished_files.h>

namespace plisse {

namespace {

using Points = Eigen::Matrix3Xf;

/// "[a, b, c]", each element put by a function.
template <typename Put>
void put_list(std::string& out, std::size_t count, const Put& put_element) {
    out += '[';
    for (std::size_t i = 0; i < count; ++i) {
        if (i > 0)
            out += ", ";
        put_element(i);
    }
    out += ']';
}

void put_points(std::string& out, const Points& points) {
    put_list(out, static_cast<std::size_t>(points.cols()), [&](std::size_t i) {
        const auto point = points.col(static_cast<Eigen::Index>(i));
        put_text(out, "({}, {}, {})", point.x(), point.y(), point.z());
    });
}

void put_corners(std::string& out, const std::vector<Face>& faces) {
    put_list(out, 3 * faces.size(), [&](std::size_t c) { put_text(out, "{}", faces[c / 3][c % 3]); });
}

Points extent_of(const Points& points) {
    Points extent(3, 2);
    extent << points.rowwise().minCoeff(), points.rowwise().maxCoeff();
    return extent;
}

std::string quoted(const std::string& text) {
    std::string out = "\"";
    for (char c : text)
        if (c == '"' || c == '\\')
            out += {'\\', c};
        else if (static_cast<unsigned char>(c) < ' ')
            put_text(out, "\\x{:02x}", static_cast<unsigned char>(c));
        else
            out += c;
    return out + '"';
}

/// Names for prims: letters, digits and _, not beginning with a digit, each given once.
class PrimNames {
public:
    std::string take(const std::string& name) {
        std::string identifier;
        for (char c : name)
            identifier += std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
        if (identifier.empty() || std::isdigit(static_cast<unsigned char>(identifier[0])))
            identifier.insert(identifier.begin(), '_');
        std::string free = identifier;
        for (int n = 2; !taken_.insert(free).second; ++n)
            free = fmt::format("{}_{}", identifier, n);
        return free;
    }

private:
    std::set<std::string> taken_;
};

/// In parentheses, one entry a line; nothing where there are none. The name is given where the identifier is another.
std::string prim_metadata(const std::string& indent, const std::string& name, const std::string& identifier,
                          std::vector<std::string> entries) {
    if (name != identifier)
        entries.push_back("displayName = " + quoted(name));
    std::string out;
    for (const std::string& entry : entries)
        put_text(out, "{}    {}\n", indent, entry);
    return out.empty() ? "" : " (\n" + out + indent + ")";
}

std::string stage_header(const std::string& root, const Playback& playback) {
    std::string out = "#usda 1.0\n(\n";
    put_text(out, "    defaultPrim = \"{}\"\n", root);
    if (playback.codes.size() > 1)
        put_text(out, "    endTimeCode = {}\n    framesPerSecond = {}\n", playback.codes.back(), playback.rate);
    out += "    metersPerUnit = 1\n";
    if (playback.codes.size() > 1)
        put_text(out, "    startTimeCode = {}\n    timeCodesPerSecond = {}\n", playback.codes.front(), playback.rate);
    return out + "    upAxis = \"Y\"\n)\n\n";
}

/// A part's values at all times: the points, which are many, wait in a file.
struct Samples {
    bool moves = false;
    Points first;
    std::string extents;
    std::filesystem::path points;
};

std::vector<Samples> sample_parts(const Animation& animation, const std::vector<PartMesh>& parts,
                                  const Playback& playback, const std::filesystem::path& path,
                                  UnfinishedFiles& unfinished) {
    const std::vector<bool> moving = find_moving_parts(animation, parts);
    std::vector<Samples> samples(parts.size());
    std::vector<OutputFile> files;
    for (Samples& sample : samples) {
        sample.points = unfinished.add_scratch(path);
        files.emplace_back(sample.points);
    }
    for (std::size_t k = 0; k < animation.size(); ++k) {
        const Positions positions = animation.state(k).positions;
        for (std::size_t p = 0; p < parts.size(); ++p) {
            samples[p].moves = moving[p];
            const Points points = parts[p].points_of(positions);
            if (k == 0)
                samples[p].first = points;
            if (!moving[p])
                continue;
            std::string row;
            put_text(row, "            {}: ", playback.codes[k]);
            samples[p].extents += row;
            put_points(samples[p].extents, extent_of(points));
            samples[p].extents += ",\n";
            put_points(row, points);
            files[p].write(row + ",\n");
        }
    }
    for (OutputFile& file : files)
        file.close();
    return samples;
}

std::string texture_properties(const TextureMap& texture) {
    if (texture.empty())
        return "";
    std::string out = "        texCoord2f[] primvars:st = ";
    put_list(out, texture.points.size(), [&](std::size_t i) {
        const Eigen::Vector2f point = texture.points[i].cast<float>();
        put_text(out, "({}, {})", point.x(), point.y());
    });
    out += " (\n            interpolation = \"faceVarying\"\n        )\n        int[] primvars:st:indices = ";
    put_corners(out, texture.faces);
    return out + "\n";
}

void write_mesh(OutputFile& file, const PartMesh& part, const Samples& samples, const std::string& identifier) {
    std::string out;
    put_text(out, "    def Mesh \"{}\"{}\n    {{\n", identifier, prim_metadata("    ", part.name, identifier, {}));
    out += "        uniform bool doubleSided = 1\n";
    if (samples.moves) {
        out += "        float3[] extent.timeSamples = {\n" + samples.extents + "        }\n";
    } else {
        out += "        float3[] extent = ";
        put_points(out, extent_of(samples.first));
        out += '\n';
    }
    out += "        int[] faceVertexCounts = ";
    put_list(out, part.faces.size(), [&](std::size_t) { out += '3'; });
    out += "\n        int[] faceVertexIndices = ";
    put_corners(out, part.faces);
    out += samples.moves ? "\n        point3f[] points.timeSamples = {\n" : "\n        point3f[] points = ";
    if (!samples.moves)
        put_points(out, samples.first);
    file.write(out);
    if (samples.moves)
        file.append(samples.points);
    out = samples.moves ? "        }\n" : "\n";
    put_text(out,
             "        color3f[] primvars:displayColor = [({}, {}, {})] (\n            interpolation = \"constant\"\n   "
             "     )\n",
             part.color[0], part.color[1], part.color[2]);
    out += texture_properties(part.texture) + "        uniform token subdivisionScheme = \"none\"\n    }\n";
    file.write(out);
}

} // namespace

void write_usd(const std::filesystem::path& path, const Animation& animation) {
    UnfinishedFiles unfinished;
    OutputFile file(unfinished.add_file(path));
    const Playback playback = playback_of(animation.times);
    const std::vector<PartMesh> parts = split_parts(animation, animation.state(0));
    const std::vector<Samples> samples = sample_parts(animation, parts, playback, path, unfinished);

    const std::string root = PrimNames().take(animation.name);
    file.write(stage_header(root, playback));
    file.write(fmt::format("def Xform \"{}\"{}\n{{\n", root,
                           prim_metadata("", animation.name, root, {"kind = \"component\""})));
    PrimNames names;
    for (std::size_t p = 0; p < parts.size(); ++p)
        write_mesh(file, parts[p], samples[p], names.take(parts[p].name));
    file.write("}\n");
    file.close();
    unfinished.finish();
}

} // namespace plisse
