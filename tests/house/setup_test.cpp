#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

namespace plisse::house {
namespace {

namespace fs = std::filesystem;

/// A copy of ./setup with a list of its own, among programs that only note down what is asked of them.
class Setup : public testing::Test {
protected:
    void SetUp() override {
        std::string pattern = testing::TempDir() + "plisse-setup-XXXXXX";
        ASSERT_NE(mkdtemp(pattern.data()), nullptr);
        folder_ = pattern;
        fs::create_directories(folder_ / "scripts");
        fs::create_directories(folder_ / "bin");
        fs::copy_file(fs::path(PLISSE_SOURCE_DIR) / "setup", folder_ / "setup");
        write_program("dpkg-query", "grep -qx -- \"${@: -1}\" \"$STATE/installed\" && printf installed");
        write_program("apt-cache", "exit 0");
        write_program("apt-get",
                      "echo \"$*\" >> \"$STATE/asked\"\nshift 3\nprintf '%s\\n' \"$@\" >> \"$STATE/installed\"");
        write_program("sudo", "exec \"$@\"");
        std::ofstream(folder_ / "installed") << "alpha\n";
    }

    void TearDown() override { fs::remove_all(folder_); }

    void write_program(const std::string& name, const std::string& body) const {
        const fs::path path = folder_ / "bin" / name;
        std::ofstream(path) << "#!/usr/bin/env bash\n" << body << "\n";
        fs::permissions(path, fs::perms::owner_all);
    }

    void list(const std::string& text) const { std::ofstream(folder_ / "scripts" / "debian-packages.txt") << text; }

    int run() const {
        const std::string command = "STATE=" + folder_.string() + " PATH=" + (folder_ / "bin").string() + ":$PATH " +
                                    (folder_ / "setup").string() + " > " + (folder_ / "said").string() + " 2>&1";
        return std::system(command.c_str());
    }

    std::string text(const std::string& name) const {
        std::ostringstream content;
        content << std::ifstream(folder_ / name).rdbuf();
        return content.str();
    }

    fs::path folder_;
};

TEST_F(Setup, InstallsWhatIsMissing) {
    list("alpha # there\nbeta\n\n# a comment\n  gamma unless=no-such-command-anywhere # needed\ndelta unless=bash # "
         "not\n");
    EXPECT_EQ(run(), 0) << text("said");
    EXPECT_EQ(text("asked"), "install --yes --no-install-recommends beta gamma\n");
}

TEST_F(Setup, AsksForNothingWhenAllIsThere) {
    list("alpha\ndelta unless=bash\n");
    EXPECT_EQ(run(), 0) << text("said");
    EXPECT_FALSE(fs::exists(folder_ / "asked"));
    EXPECT_EQ(text("said"), "setup: all 1 packages are installed\n");
}

} // namespace
} // namespace plisse::house
