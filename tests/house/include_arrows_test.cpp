#include "include_arrows.h"

#include <filesystem>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

namespace plisse::house {
namespace {

std::string read_text(const std::filesystem::path& path) {
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
}

TEST(IncludeArrows, NoneRunsUpward) {
    const std::filesystem::path root = std::filesystem::path(PLISSE_SOURCE_DIR) / "src" / "plisse";
    int files = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root)) {
        const std::string extension = entry.path().extension().string();
        if (extension != ".h" && extension != ".cpp")
            continue;
        ++files;
        const std::string folder = entry.path().lexically_relative(root).begin()->string();
        EXPECT_TRUE(is_known_folder(folder)) << entry.path();
        for (const std::string& sentence : wrong_includes(folder, read_text(entry.path())))
            ADD_FAILURE() << entry.path() << ": " << sentence;
    }
    EXPECT_GT(files, 30);
}

TEST(IncludeArrows, BadOnesAreCaught) {
    EXPECT_EQ(wrong_includes("mesh", "#include <plisse/contact/contact.h>\n").size(), 1U);
    EXPECT_EQ(wrong_includes("solve", "#include <plisse/model/model.h>\n").size(), 1U);
    EXPECT_EQ(wrong_includes("scene", "#include <plisse/picture/draw.h>\n").size(), 1U);
    EXPECT_EQ(wrong_includes("picture", "#include <plisse/spatial/box.h>\n").size(), 1U);
    EXPECT_EQ(wrong_includes("exports", "#include <plisse/scene/scene.h>\n").size(), 1U);
    EXPECT_EQ(wrong_includes("exports", "#include <plisse/picture/draw.h>\n").size(), 1U);
    EXPECT_EQ(wrong_includes("base", "int a;\n  #  include <plisse/linalg/newton_system.h> // why\n").size(), 1U);
    EXPECT_EQ(wrong_includes("drive", "#include \"../scene/scene.h\"\n").size(), 1U);
    EXPECT_EQ(wrong_includes("drive", "#include <apps/cli/main.h>\n").size(), 1U);
    EXPECT_EQ(wrong_includes("drive", "#include <plisse/unheard/of.h>\n").size(), 1U);
    EXPECT_EQ(wrong_includes("mesh", "#include <plisse/model/a.h>\n#include <plisse/solve/b.h>\n").size(), 2U);
}

TEST(IncludeArrows, GoodOnesAreNot) {
    EXPECT_TRUE(
        wrong_includes("mesh", "#include <plisse/base/types.h>\n#include <plisse/mesh/check_mesh.h>\n").empty());
    EXPECT_TRUE(wrong_includes("picture", "#include <plisse/mesh/triangle_mesh.h>\n#include <vector>\n").empty());
    EXPECT_TRUE(wrong_includes("scene", "#include <nlohmann/json.hpp>\n#include <plisse/drive/run.h>\n").empty());
    EXPECT_TRUE(wrong_includes("base", "// #include <plisse/scene/scene.h>\n").empty());
}

} // namespace
} // namespace plisse::house
