#include <algorithm>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

#include <page_assets.h>

namespace plisse::studio {
namespace {

std::string_view text(const Asset& asset) {
    return {reinterpret_cast<const char*>(asset.bytes.data()), asset.bytes.size()};
}

const Asset* find(std::string_view path) {
    const auto assets = page_assets();
    const auto found =
        std::find_if(assets.begin(), assets.end(), [&](const Asset& asset) { return asset.path == path; });
    return found == assets.end() ? nullptr : &*found;
}

TEST(PageAssets, HoldThePageWhole) {
    const Asset* page = find("index.html");
    ASSERT_NE(page, nullptr);
    EXPECT_EQ(page->mime_type, "text/html; charset=utf-8");
    EXPECT_TRUE(text(*page).starts_with("<!doctype html>"));
    EXPECT_TRUE(text(*page).ends_with("</html>\n"));
}

TEST(PageAssets, HoldEverythingThatThePageRefersTo) {
    const std::string page(text(*find("index.html")));
    int references = 0;
    for (std::size_t at = page.find("\"/assets/"); at != std::string::npos; at = page.find("\"/assets/", at + 1)) {
        const std::string path = page.substr(at + 2, page.find('"', at + 1) - at - 2);
        EXPECT_NE(find(path), nullptr) << path;
        ++references;
    }
    EXPECT_GE(references, 2);
}

TEST(PageAssets, RunNoScriptThatThePolicyForbids) {
    const std::string page(text(*find("index.html")));
    for (std::size_t at = page.find("<script"); at != std::string::npos; at = page.find("<script", at + 1))
        EXPECT_NE(page.substr(at, page.find('>', at) - at).find(" src="), std::string::npos);
}

} // namespace
} // namespace plisse::studio
