#include <plisse/scene/hierarchy_cache.h>

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <iterator>

#include "decimate/test_meshes.h"

using namespace plisse;

namespace {

namespace fs = std::filesystem;

/// Remembers what it is told.
struct Listener : Context {
    std::vector<std::string> messages;
    void on_message(const std::string& message) override { messages.push_back(message); }
};

class HierarchyCaches : public testing::Test {
protected:
    void SetUp() override {
        folder = fs::path(testing::TempDir()) / testing::UnitTest::GetInstance()->current_test_info()->name();
        fs::remove_all(folder);
        const test::TestMesh mesh = test::sphere(16, 12);
        DecimationOptions options;
        options.coarsest_vertices = 60;
        result.hierarchy = decimate(mesh.input(), options, nullptr, &result.summary);
    }
    void TearDown() override { fs::remove_all(folder); }

    fs::path file() const { return folder / "0123.hierarchy"; }
    std::string content() const {
        std::ifstream in(file(), std::ios::binary);
        return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
    }
    void replace_content(const std::string& bytes) const {
        std::ofstream(file(), std::ios::binary | std::ios::trunc) << bytes;
    }

    fs::path folder;
    DecimationResult result;
    Listener listener;
    HierarchyCache cache() { return {folder, listener}; }
};

TEST_F(HierarchyCaches, GiveBackWhatTheyKept) {
    EXPECT_FALSE(cache().load("0123"));
    cache().save("0123", result);
    const auto loaded = cache().load("0123");
    ASSERT_TRUE(loaded);
    EXPECT_EQ(to_bytes(*loaded), to_bytes(result));
    EXPECT_FALSE(cache().load("0124"));
    EXPECT_TRUE(listener.messages.empty());
}

TEST_F(HierarchyCaches, SayThatAFileIsDamagedAndDoWithout) {
    cache().save("0123", result);
    std::string bytes = content();
    bytes[bytes.size() / 2] ^= 4;
    replace_content(bytes);
    EXPECT_FALSE(cache().load("0123"));
    replace_content(content().substr(0, bytes.size() / 2));
    EXPECT_FALSE(cache().load("0123"));
    ASSERT_EQ(listener.messages.size(), 2u);
    for (const std::string& message : listener.messages)
        EXPECT_EQ(message, file().string() + ": the cached hierarchy is damaged; the hierarchy is built again");
}

TEST_F(HierarchyCaches, SayThatAFileIsStaleAndDoWithout) {
    cache().save("0123", result);
    std::string bytes = content();
    const std::size_t sources = bytes.find("sources ") + 8;
    bytes[sources] = bytes[sources] == '0' ? '1' : '0';
    replace_content(bytes);
    EXPECT_FALSE(cache().load("0123"));
    ASSERT_EQ(listener.messages.size(), 1u);
    EXPECT_NE(listener.messages[0].find("stale"), std::string::npos) << listener.messages[0];
    cache().save("0123", result);
    EXPECT_TRUE(cache().load("0123"));
}

TEST_F(HierarchyCaches, SayThatTheyCannotBeWritten) {
    std::ofstream(folder.string()) << "a file where the folder should be";
    cache().save("0123", result);
    ASSERT_EQ(listener.messages.size(), 1u);
    EXPECT_TRUE(listener.messages[0].starts_with("the hierarchy could not be cached")) << listener.messages[0];
}

TEST_F(HierarchyCaches, KeepTheFilesUsedLast) {
    HierarchyCache kept = cache();
    const auto age = [&](const std::string& name, int hours) {
        fs::last_write_time(folder / (name + ".hierarchy"),
                            fs::file_time_type::clock::now() - std::chrono::hours(hours));
    };
    for (int f = 0; f < HierarchyCache::most_files; ++f) {
        const std::string name = std::to_string(f);
        kept.save(name, result);
        age(name, 100 - f);
    }
    EXPECT_TRUE(kept.load("0")); // the oldest, until now
    kept.save("another", result);
    EXPECT_TRUE(kept.load("0"));
    EXPECT_FALSE(kept.load("1"));
    EXPECT_TRUE(kept.load("2"));
}

TEST_F(HierarchyCaches, LieWhereTheEnvironmentSays) {
    const auto folder_with = [](const char* own, const char* caches, const char* home) {
        const auto set = [](const char* name, const char* value) { value ? setenv(name, value, 1) : unsetenv(name); };
        set("PLISSE_CACHE", own);
        set("XDG_CACHE_HOME", caches);
        set("HOME", home);
        const auto found = HierarchyCache::default_folder();
        return found ? found->string() : "none";
    };
    EXPECT_EQ(folder_with("/a", "/b", "/c"), "/a");
    EXPECT_EQ(folder_with("", "/b", "/c"), "none");
    EXPECT_EQ(folder_with(nullptr, "/b", "/c"), "/b/plisse");
    EXPECT_EQ(folder_with(nullptr, "", "/c"), "/c/.cache/plisse");
    EXPECT_EQ(folder_with(nullptr, nullptr, nullptr), "none");
}

} // namespace
