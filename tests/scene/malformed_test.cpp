#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <plisse/scene/build_model.h>
#include <plisse/scene/build_subdivision_model.h>
#include <plisse/scene/read_scene.h>

namespace plisse {
namespace {

const std::filesystem::path folder = std::filesystem::path(PLISSE_SOURCE_DIR) / "tests/data/malformed";

/// Reads a scene, or a mesh as the only body of a scene, as far as a run would.
void load(const std::string& file) {
    Context context;
    const bool is_scene = std::filesystem::path(file).extension() == ".json";
    const Scene scene =
        is_scene ? read_scene(folder / file)
                 : parse_scene("scene.json", R"({"plisse": 1, "bodies": [{"mesh": ")" + file + R"("}]})", folder);
    if (scene.solve.method == Method::rmtr)
        build_subdivision_model(scene, context);
    else
        build_model(scene, context);
}

TEST(Malformed, EveryFileIsRefusedWithItsNameAndPlace) {
    std::ifstream in(folder / "manifest.json");
    const auto manifest = nlohmann::json::parse(in);
    EXPECT_GE(manifest.size(), 60u);
    for (const auto& [file, fragment] : manifest.items()) {
        SCOPED_TRACE(file);
        try {
            load(file);
            ADD_FAILURE() << "it was taken";
        } catch (const InputError& error) {
            const std::string message = error.what();
            EXPECT_NE(message.find(file), std::string::npos) << message;
            EXPECT_NE(message.find(fragment.get<std::string>()), std::string::npos) << message;
            EXPECT_NE(message.find("; "), std::string::npos) << "no remedy: " << message;
        }
    }
}

TEST(Malformed, TheGoodMeshesBesideThemAreTaken) {
    EXPECT_NO_THROW(load("good/square.obj"));
    EXPECT_NO_THROW(load("good/triangle.obj"));
    EXPECT_NO_THROW(load("good/joined_sheets.obj"));
}

} // namespace
} // namespace plisse
