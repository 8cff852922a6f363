#include <gtest/gtest.h>

#include <filesystem>

#include <plisse/scene/build_model.h>
#include <plisse/scene/read_scene.h>

namespace {

using namespace plisse;
namespace fs = std::filesystem;

const fs::path examples = fs::path(PLISSE_SOURCE_DIR) / "examples";

TEST(Examples, AreAllUnderstood) {
    int count = 0;
    for (const auto& entry : fs::recursive_directory_iterator(examples))
        if (entry.path().extension() == ".json") {
            EXPECT_EQ(read_scene(entry.path()).name, entry.path().stem()) << entry.path();
            ++count;
        }
    EXPECT_GE(count, 5);
}

TEST(Examples, OfTheDemonstrationAreAsLargeAsPromised) {
    Context context;
    const Model drape = build_model(read_scene(examples / "drape.json"), context);
    EXPECT_GE(drape.bodies.front().vertices.size(), 10000);
    const Model pumpkin = build_model(read_scene(examples / "pumpkin_press.json"), context);
    EXPECT_GE(pumpkin.bodies.front().vertices.size(), 8000);
}

} // namespace
