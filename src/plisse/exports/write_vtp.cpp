#include <plisse/exports/write_vtp.h>

#include <cstdint>
#include <string>

#include <plisse/exports/text_output.h>
#include <plisse/exports/unfinished_files.h>
#include <plisse/exports/xml_text.h>
#include <plisse/mesh/binary_bytes.h>

namespace plisse {

namespace {

using Domain = MeshAttribute::Domain;

/// The arrays' bytes, one after the other, each behind its length; the XML refers to them by where they begin.
class AppendedData {
public:
    /// Returns the element that stands for the array.
    template <typename T, typename Values>
    std::string add(const char* type, const std::string& name, int width, const Values& values) {
        const std::size_t offset = bytes_.size();
        put_little_endian(bytes_, static_cast<std::uint64_t>(sizeof(T) * values.size()));
        for (auto value : values)
            put_little_endian(bytes_, static_cast<T>(value));
        return fmt::format("        <DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"appended\" "
                           "offset=\"{}\"/>\n",
                           type, xml_escaped(name), width, offset);
    }

    std::string add_attribute(const MeshAttribute& attribute) {
        using Number = MeshAttribute::Number;
        if (attribute.number == Number::int32)
            return add<std::int32_t>("Int32", attribute.name, attribute.width, attribute.values);
        if (attribute.number == Number::uint8)
            return add<std::uint8_t>("UInt8", attribute.name, attribute.width, attribute.values);
        return add<double>("Float64", attribute.name, attribute.width, attribute.values);
    }

    const std::string& bytes() const { return bytes_; }

private:
    std::string bytes_;
};

std::string point_data(AppendedData& data, const TriangleMesh& mesh) {
    std::string arrays;
    bool has_texture = false;
    for (const MeshAttribute& attribute : mesh.attributes)
        if (attribute.domain == Domain::vertex) {
            has_texture = has_texture || (attribute.name == "uv" && attribute.width == 2);
            arrays += data.add_attribute(attribute);
        }
    return std::string("      <PointData") + (has_texture ? " TCoords=\"uv\"" : "") + ">\n" + arrays +
           "      </PointData>\n";
}

std::string cell_data(AppendedData& data, const TriangleMesh& mesh, std::span<const int> face_part) {
    std::string arrays = data.add<std::int32_t>("Int32", "body", 1, face_part);
    for (const MeshAttribute& attribute : mesh.attributes)
        if (attribute.domain == Domain::face && attribute.name != "body")
            arrays += data.add_attribute(attribute);
    return "      <CellData>\n" + arrays + "      </CellData>\n";
}

std::string points(AppendedData& data, const TriangleMesh& mesh) {
    return "      <Points>\n" + data.add<double>("Float64", "Points", 3, mesh.positions.reshaped()) +
           "      </Points>\n";
}

std::string polygons(AppendedData& data, const TriangleMesh& mesh) {
    std::vector<int> corners, ends;
    for (const Face& face : mesh.faces) {
        corners.insert(corners.end(), face.begin(), face.end());
        ends.push_back(static_cast<int>(corners.size()));
    }
    return "      <Polys>\n" + data.add<std::int32_t>("Int32", "connectivity", 1, corners) +
           data.add<std::int32_t>("Int32", "offsets", 1, ends) + "      </Polys>\n";
}

} // namespace

void write_vtp(const std::filesystem::path& path, const TriangleMesh& mesh, std::span<const int> face_part,
               double time) {
    AppendedData data;
    std::string out = "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" "
                      "header_type=\"UInt64\">\n  <PolyData>\n";
    put_text(out,
             "    <FieldData>\n      <DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" "
             "format=\"ascii\">{}</DataArray>\n    </FieldData>\n",
             time);
    put_text(out,
             "    <Piece NumberOfPoints=\"{}\" NumberOfVerts=\"0\" NumberOfLines=\"0\" NumberOfStrips=\"0\" "
             "NumberOfPolys=\"{}\">\n",
             mesh.vertex_count(), mesh.face_count());
    out += point_data(data, mesh);
    out += cell_data(data, mesh, face_part);
    out += points(data, mesh);
    out += polygons(data, mesh);
    out += "    </Piece>\n  </PolyData>\n  <AppendedData encoding=\"raw\">\n_";
    OutputFile file(path);
    file.write(out);
    file.write(data.bytes());
    file.write("\n  </AppendedData>\n</VTKFile>\n");
    file.close();
}

} // namespace plisse
