#include <studio/http_text.h>

#include <gtest/gtest.h>

namespace plisse::studio {
namespace {

TEST(HttpText, TargetsAreDecoded) {
    const auto target = parse_target("/api/mesh?name=a+b%2Fc%C3%A9.obj&empty=&flag&name2=%26%3D");
    ASSERT_TRUE(target);
    EXPECT_EQ(target->path, "/api/mesh");
    const std::map<std::string, std::string> expected = {
        {"name", "a b/c\xC3\xA9.obj"}, {"empty", ""}, {"flag", ""}, {"name2", "&="}};
    EXPECT_EQ(target->query, expected);
    EXPECT_EQ(parse_target("/")->path, "/");
    EXPECT_EQ(parse_target("/a%20b+c")->path, "/a b+c");
    EXPECT_EQ(parse_target("/a/")->path, "/a/");
    EXPECT_EQ(parse_target("/...")->path, "/...");
}

TEST(HttpText, WhatIsNoPathIsRefused) {
    for (const char* text : {"",          "a",       "*",         "http://127.0.0.1/",
                             "//",        "/a//b",   "/..",       "/../a",
                             "/a/..",     "/a/../b", "/.",        "/a/./b",
                             "/%2e%2e/a", "/%2E./a", "/..%2fa",   "/a\\b",
                             "/a%5cb",    "/%00",    "/a%0d%0ab", "/%",
                             "/%4",       "/%zz",    "/a?b=%",    "/a?%0a=1",
                             "/\x7f"})
        EXPECT_FALSE(parse_target(text)) << text;
}

TEST(HttpText, CookiesAreFoundWhole) {
    EXPECT_TRUE(has_cookie("plisse_token=abc", "plisse_token", "abc"));
    EXPECT_TRUE(has_cookie("a=b; plisse_token=abc; c=d", "plisse_token", "abc"));
    EXPECT_TRUE(has_cookie("plisse_token=old; plisse_token=abc", "plisse_token", "abc"));
    for (const char* field : {"", "plisse_token", "plisse_token=", "plisse_token=ab", "plisse_token=abcd",
                              "plisse_token=abC", "x_plisse_token=abc", "a=plisse_token=abc", ";;;", "   "})
        EXPECT_FALSE(has_cookie(field, "plisse_token", "abc")) << field;
}

TEST(HttpText, DownloadNamesCannotLeaveTheirField) {
    EXPECT_EQ(safe_download_name("drape.json"), "drape.json");
    EXPECT_EQ(safe_download_name("a\"\r\n/\\\xC3\xA9"), "a_______");
}

} // namespace
} // namespace plisse::studio
