#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

namespace plisse::house {
namespace {

/// The first fenced block of the given kind.
std::string first_block(const std::string& text, const std::string& kind) {
    const std::string fence = "```" + kind + "\n";
    const std::size_t start = text.find(fence);
    if (start == std::string::npos)
        return "";
    const std::size_t begin = start + fence.size();
    return text.substr(begin, text.find("```", begin) - begin);
}

TEST(Readme, ItsFirstSceneRuns) {
    std::ostringstream readme;
    readme << std::ifstream(std::filesystem::path(PLISSE_SOURCE_DIR) / "README.md").rdbuf();
    const std::string scene = first_block(readme.str(), "json");
    ASSERT_FALSE(scene.empty());

    std::string pattern = testing::TempDir() + "plisse-readme-XXXXXX";
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    const std::filesystem::path folder = pattern;
    std::ofstream(folder / "first.json") << scene;
    const std::string command = std::string(PLISSE_PROGRAM) + " run " + (folder / "first.json").string() + " -o " +
                                (folder / "out").string() + " --quiet";
    EXPECT_EQ(std::system(command.c_str()), 0) << command;
    EXPECT_TRUE(std::filesystem::exists(folder / "out" / "final.ply"));
    std::filesystem::remove_all(folder);
}

TEST(Readme, RefersToFilesThatExist) {
    std::ifstream readme(std::filesystem::path(PLISSE_SOURCE_DIR) / "README.md");
    int links = 0;
    for (std::string line; std::getline(readme, line);)
        for (std::size_t at = line.find("]("); at != std::string::npos; at = line.find("](", at + 1)) {
            const std::string target = line.substr(at + 2, line.find(')', at) - at - 2);
            if (target.starts_with("http"))
                continue;
            ++links;
            EXPECT_TRUE(std::filesystem::exists(std::filesystem::path(PLISSE_SOURCE_DIR) / target)) << target;
        }
    EXPECT_GT(links, 0);
}

} // namespace
} // namespace plisse::house
