#include <gtest/gtest.h>

#include <studio/scene_files.h>

#include <plisse/base/error.h>
#include <plisse/scene/read_scene.h>

namespace plisse::studio {
namespace {

Scene scene_with(const std::string& mesh, const std::string& more = "") {
    return parse_scene("scene.json", "{\"plisse\": 1, \"bodies\": [{\"mesh\": \"" + mesh + "\"" + more + "}]}", ".");
}

TEST(SceneFiles, OfAPageStayInTheFolder) {
    EXPECT_NO_THROW(expect_no_other_files(scene_with("meshes/a.obj"), {}, "."));
    EXPECT_NO_THROW(expect_no_other_files(scene_with("meshes/../a.obj"), {}, "."));
    EXPECT_NO_THROW(expect_no_other_files(scene_with("/home/a.obj"), {"/home/a.obj"}, "."));
    for (const char* file : {"/etc/passwd", "../a.obj", "meshes/../../a.obj", "/home/a.obj"})
        EXPECT_THROW(expect_no_other_files(scene_with(file), {"/home/b.obj"}, "."), InputError) << file;
    EXPECT_THROW(expect_no_other_files(scene_with("a.obj", R"(, "start": "../b.obj")"), {}, "."), InputError);
    EXPECT_THROW(expect_no_other_files(scene_with("a.obj", R"(, "rest": {"mesh": "/b.obj"})"), {}, "."), InputError);
    EXPECT_THROW(expect_no_other_files(scene_with("a.obj"), {}, "elsewhere"), InputError);
    Scene scene = scene_with("a.obj");
    scene.edits = "../log.json";
    EXPECT_THROW(expect_no_other_files(scene, {}, "."), InputError);
}

} // namespace
} // namespace plisse::studio
