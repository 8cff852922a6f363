#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <plisse/scene/material_presets.h>
#include <plisse/scene/motion_track.h>
#include <plisse/scene/overrides.h>
#include <plisse/scene/read_scene.h>
#include <plisse/scene/write_scene.h>

namespace plisse {
namespace {

Scene parse(const std::string& text) {
    return parse_scene("folder/drape.json", text, "folder");
}

std::string message_of(const std::string& text) {
    try {
        parse(text);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

const std::string full_scene = R"({
  "plisse": 1, // format version
  "name": "drape", "x-note": {"anything": [1, 2]},
  "bodies": [{
    "name": "cloth", "mesh": "cloth.obj",
    "transform": {"scale": 2, "rotate_deg": [10, 20, 30], "translate": [0, 1, 0]},
    "material": {"density": 400, "youngs_modulus": 7e5, "poisson_ratio": 0.3, "thickness": 0.0004,
                 "bending": "hinge", "bending_scale": 3, "strain_limit": 1.1},
    "pressure": [[0, 0], [1, 250.5]],
    "rest": {"mesh": "rest.obj"}, "start": "start.obj"
  }, {"mesh": {"generate": "sheet", "size": [1, 2], "cells": [4, 8], "pattern": "regular", "diagonals": "one"},
      "material": "steel", "rest": "flat-angles"}],
  "obstacles": [{
    "name": "ball", "mesh": {"generate": "sphere", "radius": 0.2, "edge_length": 0.03, "seed": 7}, "transform": {},
    "motion": [{"t": 0, "translate": [0, 0, 0]}, {"t": 2, "translate": [0, 0.3, 0]}], "progressive": false
  }],
  "handles": [{
    "name": "left", "body": "cloth", "axes": "xz", "select": {"box": [[-1, 0.9, -1], [-0.4, 1.1, 1]]},
    "motion": [{"t": 0}, {"t": 15, "rotate_deg": [720, 0, 0], "about": [0, 1, 0]}]
  }, {"body": "body-1", "select": {"sphere": [[1, 2, 3], 0.5]}}, {"body": "body-1", "select": {"boundary_loop": 0}}],
  "loads": [{"body": "cloth", "select": {"vertices": [3, 4]}, "force": [0, -1, 0]},
            {"body": "cloth", "traction": [[0, [0, 0, 0]], [1, [0, 5, 0]]]}],
  "gravity": [[0, [0, -9.81, 0]], [1, [0, -1.6, 0]]],
  "contact": {"distance": 2e-3, "thickness": 0, "friction": 0.3, "friction_velocity": 2e-3, "self": false,
              "pairs": [{"a": "cloth", "b": "ball", "friction": 0.7}]},
  "hierarchy": {"levels": 4, "coarsest_vertices": 300, "operator": "intrinsic", "bending_on": "level",
                "source": "decimation"},
  "solve": {"method": "direct", "level": 2, "time_step": 0.05, "duration": 15, "settle": false, "max_settle_steps": 20,
            "tolerance": 1e-4, "max_iterations_per_step": 20, "frame_interval": 0.2, "curvature": "galerkin",
            "gradient": "lagged", "dynamics": true} /* the end */
})";

TEST(SceneFile, ReadsEveryKey) {
    const Scene s = parse(full_scene);
    EXPECT_EQ(s.name, "drape");
    ASSERT_EQ(s.bodies.size(), 2u);
    const BodySpec& cloth = s.bodies[0];
    EXPECT_EQ(cloth.mesh.file, "cloth.obj");
    EXPECT_EQ(cloth.transform.scale, 2);
    EXPECT_EQ(cloth.transform.rotate_deg, Vec3(10, 20, 30));
    EXPECT_EQ(cloth.material.youngs_modulus, 7e5);
    EXPECT_EQ(cloth.material.bending_scale, 3);
    EXPECT_EQ(cloth.material.strain_limit, 1.1);
    EXPECT_EQ(cloth.pressure.at(0.5), 125.25);
    EXPECT_EQ(cloth.rest.kind, RestSpec::Kind::mesh);
    EXPECT_EQ(cloth.rest.mesh.file, "rest.obj");
    EXPECT_EQ(cloth.start->file, "start.obj");
    EXPECT_EQ(s.bodies[1].name, "body-1");
    EXPECT_EQ(s.bodies[1].mesh.generator.cells, (std::array{4, 8}));
    EXPECT_EQ(s.bodies[1].mesh.generator.diagonals, Diagonals::one);
    EXPECT_EQ(s.bodies[1].material.youngs_modulus, find_material_preset("steel")->material.youngs_modulus);
    EXPECT_EQ(s.bodies[1].rest.kind, RestSpec::Kind::flat_angles);
    EXPECT_EQ(s.obstacles.at(0).mesh.generator.seed, 7u);
    EXPECT_FALSE(s.obstacles[0].progressive);
    EXPECT_EQ(s.handles.at(0).axes, (std::array{true, false, true}));
    EXPECT_EQ(std::get<BoxSelection>(s.handles[0].select).low, Vec3(-1, 0.9, -1));
    EXPECT_EQ(std::get<SphereSelection>(s.handles[1].select).radius, 0.5);
    EXPECT_EQ(std::get<LoopSelection>(s.handles[2].select).loop, 0);
    EXPECT_EQ(s.handles[2].name, "handle-2");
    EXPECT_EQ(std::get<VertexSelection>(*s.loads.at(0).select).vertices, (std::vector{3, 4}));
    EXPECT_EQ(s.loads[0].force->at(0), Vec3(0, -1, 0));
    EXPECT_EQ(s.loads.at(1).traction->at(0.5), Vec3(0, 2.5, 0));
    EXPECT_NEAR(s.gravity.at(0.5).y(), -5.705, 1e-12);
    EXPECT_EQ(s.contact.distance, 2e-3);
    EXPECT_FALSE(s.contact.self);
    EXPECT_EQ(s.contact.friction, 0.3);
    EXPECT_EQ(s.contact.friction_velocity, 2e-3);
    EXPECT_EQ(s.contact.pairs.at(0).b, "ball");
    EXPECT_EQ(s.contact.pairs.at(0).friction, 0.7);
    EXPECT_EQ(s.hierarchy.prolongation, ProlongationOperator::intrinsic);
    EXPECT_EQ(s.hierarchy.bending_on, BendingOn::level);
    EXPECT_EQ(s.solve.method, Method::direct);
    EXPECT_EQ(s.solve.level, 2);
    EXPECT_EQ(s.solve.max_iterations_per_step, 20);
    EXPECT_EQ(s.solve.curvature, Curvature::galerkin);
    EXPECT_EQ(s.solve.gradient, GradientKind::lagged);
    EXPECT_TRUE(s.solve.dynamics);
}

TEST(SceneFile, WhatIsWrittenReadsBackTheSame) {
    const std::string once = scene_to_json(parse(full_scene)).dump();
    EXPECT_EQ(scene_to_json(parse(once)).dump(), once);
    const std::string small = R"({"plisse": 1, "bodies": [{"mesh": "a.obj"}]})";
    const std::string filled = scene_to_json(parse(small)).dump();
    EXPECT_EQ(scene_to_json(parse(filled)).dump(), filled);
}

TEST(SceneFile, FillsInDefaults) {
    const Scene s = parse(R"({"plisse": 1, "bodies": [{"mesh": "a.obj"}]})");
    EXPECT_EQ(s.name, "drape") << "the file's name";
    EXPECT_EQ(s.bodies[0].name, "body-0");
    EXPECT_EQ(s.bodies[0].material.density, find_material_preset("cotton")->material.density);
    EXPECT_FALSE(s.bodies[0].material.strain_limit.has_value());
    EXPECT_EQ(s.gravity.at(0), Vec3(0, -9.81, 0));
    EXPECT_EQ(s.hierarchy.levels, 3);
    EXPECT_EQ(s.hierarchy.bending_on, BendingOn::level);
    EXPECT_FALSE(s.solve.level.has_value());
    EXPECT_FALSE(s.solve.max_iterations_per_step.has_value());
}

TEST(SceneFile, BendingIsOnTheMeshThatSuitsTheOperator) {
    const auto bending = [](const std::string& hierarchy) {
        return parse(R"({"plisse": 1, "bodies": [{"mesh": "a.obj"}], "hierarchy": {)" + hierarchy + "}}")
            .hierarchy.bending_on;
    };
    EXPECT_EQ(bending(R"("operator": "shell")"), BendingOn::level);
    EXPECT_EQ(bending(R"("operator": "blend")"), BendingOn::finest);
    EXPECT_EQ(bending(R"("source": "loop")"), BendingOn::finest);
    EXPECT_EQ(bending(R"("operator": "blend", "bending_on": "level")"), BendingOn::level);
    EXPECT_EQ(bending(R"("bending_on": "finest")"), BendingOn::finest);
}

TEST(SceneFile, ErrorsNameLineAndColumn) {
    const std::string text = "{\n  \"plisse\": 1,\n  \"bodies\": [{\"mesh\": \"a.obj\",\n     \"presure\": 3}]\n}\n";
    EXPECT_EQ(message_of(text),
              "folder/drape.json:4:17: at /bodies/0/presure: unknown key \"presure\"; the nearest known "
              "key is \"pressure\"");
}

TEST(SceneFile, FeaturesOfLaterVersionsSaySo) {
    const auto with = [](const std::string& rest, const std::string& body = "") {
        return R"({"plisse": 1, "bodies": [{"name": "a", "mesh": "a.obj")" + body + "}]" + rest + "}";
    };
    const std::vector<std::string> later = {
        with(R"(, "obstacles": [{"mesh": "b.obj", "motion": {"frames": "f/*.obj", "dt": 0.04}}])"),
        with("", R"(, "pressure": {"gas": 100})"),
        with("", R"(, "pressure": {"volume": 1.2})"),
    };
    for (const std::string& text : later)
        EXPECT_NE(message_of(text).find("is not supported in this version; "), std::string::npos) << text << "\n"
                                                                                                  << message_of(text);
}

TEST(SceneFile, LevelsBySubdivisionHaveTheirOwnOperators) {
    const auto with = [](const std::string& hierarchy) {
        return R"({"plisse": 1, "bodies": [{"mesh": "a.obj"}], "hierarchy": {)" + hierarchy + "}}";
    };
    const Scene loop = parse(with(R"("source": "loop")"));
    EXPECT_EQ(loop.hierarchy.source, HierarchySource::loop);
    EXPECT_EQ(loop.hierarchy.prolongation, ProlongationOperator::loop);
    EXPECT_EQ(parse(scene_to_json(loop).dump()).hierarchy.prolongation, ProlongationOperator::loop);
    EXPECT_FALSE(scene_to_json(loop)["hierarchy"].contains("coarsest_vertices"));
    const Scene shell = parse(with(R"("operator": "shell", "source": "loop")"));
    EXPECT_EQ(shell.hierarchy.prolongation, ProlongationOperator::shell);
    EXPECT_EQ(parse(scene_to_json(shell).dump()).hierarchy.prolongation, ProlongationOperator::shell);

    const auto wrong = [&](const std::string& hierarchy, const std::string& part) {
        EXPECT_NE(message_of(with(hierarchy)).find(part), std::string::npos) << message_of(with(hierarchy));
    };
    wrong(R"("operator": "loop")",
          "at /hierarchy/operator: the operator loop needs levels made by subdivision; set `source` to \"loop\"");
    wrong(R"("operator": "affine", "source": "loop")",
          "at /hierarchy/operator: the operator affine needs levels made by decimation; take loop");
    wrong(R"("source": "loop", "coarsest_vertices": 500)",
          "at /hierarchy/coarsest_vertices: this key means nothing here; leave it out");
}

TEST(SceneFile, EveryPresetHasSoundValuesAndASource) {
    for (const char* name : {"cotton", "denim", "silk", "rubber", "mylar", "aluminium", "steel", "acrylic"}) {
        const MaterialPreset* preset = find_material_preset(name);
        ASSERT_NE(preset, nullptr) << name;
        EXPECT_FALSE(preset->source.empty()) << name;
        EXPECT_GT(preset->material.density, 100) << name;
        EXPECT_LT(preset->material.density, 20000) << name;
        EXPECT_GT(preset->material.youngs_modulus, 1e5) << name;
        EXPECT_LT(preset->material.youngs_modulus, 1e12) << name;
        EXPECT_LT(preset->material.poisson_ratio, 0.5) << name;
        EXPECT_LT(preset->material.thickness, 0.01) << name;
    }
}

TEST(MotionTrack, FieldsLeftOutKeepTheirLastValue) {
    const MotionSpec spec = {{0, {}, {}, {}},
                             {2, Vec3(1, 0, 0), {}, {}},
                             {4, {}, Vec3(0, 0, 90), Vec3(0, 1, 0)},
                             {6, Vec3(3, 0, 0), {}, {}}};
    const MotionTrack track = motion_track(spec);
    EXPECT_EQ(track.translate.at(1), Vec3(0.5, 0, 0));
    EXPECT_EQ(track.translate.at(3), Vec3(1, 0, 0)) << "held between the keys that give it";
    EXPECT_EQ(track.translate.at(5), Vec3(2, 0, 0));
    EXPECT_EQ(track.rotate_deg.at(3), Vec3(0, 0, 45));
    EXPECT_EQ(track.rotate_deg.at(9), Vec3(0, 0, 90));
    EXPECT_EQ(track.about.at(0), Vec3(0, 1, 0)) << "a pivot does not wander";
    EXPECT_LT((track.apply(Vec3(1, 1, 0), 4) - Vec3(1, 2, 0)).norm(), 1e-12);
}

TEST(Overrides, ReplaceMethodAndLevel) {
    Scene s = parse(full_scene);
    override_solve(s, std::nullopt, 1);
    EXPECT_EQ(s.solve.level, 1);
    override_solve(s, "progressive", std::nullopt);
    EXPECT_EQ(s.solve.method, Method::progressive);
    EXPECT_FALSE(s.solve.level.has_value());
    EXPECT_THROW(override_solve(s, std::nullopt, 1), InputError);
    EXPECT_THROW(override_solve(s, "direct", 4), InputError);
    override_solve(s, "rmtr", std::nullopt);
    EXPECT_EQ(s.solve.method, Method::rmtr);
    EXPECT_THROW(override_solve(s, "rmtr", 1), InputError);
    EXPECT_THROW(override_solve(s, "multigrid", std::nullopt), InputError);
}

} // namespace
} // namespace plisse
