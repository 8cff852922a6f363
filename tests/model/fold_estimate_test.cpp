#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include <plisse/model/discretization.h>
#include <plisse/model/fold_estimate.h>

#include "drive/small_models.h"

using namespace plisse;

namespace {

constexpr double pi = std::numbers::pi;
constexpr double mean_share = 0.43; ///< of the largest curvature, as the estimate takes it

/// D 1/12 N m, E t 1000 N/m.
const Material material{2000, 1e6, 0, 1e-3, 1000};

/// A flat body alone, one metre wide.
Model sheet_model(double edge_length, const Material& of, const Vec3& gravity = Vec3::Zero()) {
    Model model = empty_model("sheet");
    add_body(model, "sheet", of, sheet_mesh(1, edge_length));
    model.gravity = Track<Vec3>(gravity);
    return model;
}

Model shell_model(GeneratorShape shape, const Material& of) {
    GeneratorOptions options;
    options.shape = shape;
    options.radius = 0.1;
    options.angle_deg = 60;
    options.edge_length = 0.01;
    Model model = empty_model("shell");
    add_body(model, "shell", of, generate_mesh(options));
    model.gravity = Track<Vec3>(Vec3::Zero());
    model.solve.duration = 1;
    return model;
}

/// Takes the sheet's left and right edges by a handle each.
void add_edge_handles(Model& model, const MotionTrack& left, const MotionTrack& right) {
    for (const auto& [side, motion] : {std::pair(-0.5, left), std::pair(0.5, right)}) {
        Handle handle;
        handle.motion = motion;
        for (int v = 0; v < model.mesh.vertex_count(); ++v)
            if (std::abs(model.mesh.positions(0, v) - side) < 1e-9)
                handle.vertices.push_back(v);
        model.handles.push_back(handle);
    }
    model.solve.duration = 1;
}

MotionTrack move(const Vec3& by) {
    MotionTrack motion;
    motion.translate.keys = {{0, Vec3::Zero()}, {1, by}};
    return motion;
}

MotionTrack turn(const Vec3& degrees) {
    MotionTrack motion;
    motion.rotate_deg.keys = {{0, Vec3::Zero()}, {1, degrees}};
    return motion;
}

const FoldScale* find(const std::vector<FoldScale>& scales, FoldCause cause) {
    for (const FoldScale& scale : scales)
        if (scale.cause == cause)
            return &scale;
    return nullptr;
}

TEST(FoldLengths, AreTheirClosedForms) {
    EXPECT_NEAR(bending_length(2, 0.25), 2, 1e-14);
    EXPECT_NEAR(wrinkle_length(1.6e-5, 1, pi / 4), 2 * pi / 2 * 0.2 * std::pow(0.01, 0.25), 1e-14);
    EXPECT_NEAR(ridge_radius(8e-6, 1), 0.02, 1e-14);
    EXPECT_NEAR(ridge_radius(1e-3, 0.1), std::pow(0.1, 2.0 / 3) * 0.1, 1e-14);
}

TEST(FoldLengths, TheRadiusOfAShapeIsThatOfItsMeanCurvature) {
    const TriangleMesh flat = sheet_mesh(1, 0.1), ball = sphere_mesh(0.2, 0.03);
    EXPECT_TRUE(std::isinf(curvature_radius(flat.positions, flat.faces)));
    EXPECT_NEAR(curvature_radius(ball.positions, ball.faces), 0.2, 0.01);
    GeneratorOptions options;
    options.shape = GeneratorShape::cylinder;
    options.radius = 0.1;
    options.height = 0.4;
    options.edge_length = 0.02;
    const TriangleMesh tube = generate_mesh(options);
    EXPECT_NEAR(curvature_radius(tube.positions, tube.faces), 0.2, 0.02);
}

TEST(FoldScales, NothingFoldsASheetWithoutLoads) {
    const std::vector<FoldScale> scales = fold_scales(sheet_model(0.2, material), 0);
    ASSERT_EQ(scales.size(), 1U);
    EXPECT_EQ(scales[0].cause, FoldCause::shape);
    EXPECT_TRUE(std::isinf(scales[0].radius));
}

TEST(FoldScales, WeightFoldsAsHangingCloth) {
    Material cloth = material; // D 1/12000 N m
    cloth.bending_scale = 1;
    const FoldScale folds = fold_scales(sheet_model(0.2, cloth, Vec3(0, -10, 0)), 0).front(); // 20 N/m^2
    EXPECT_EQ(folds.cause, FoldCause::weight);
    EXPECT_NEAR(folds.length, 2 * std::sqrt(pi) * std::pow(1.0 / 12000 / 20, 0.25), 1e-12);
    EXPECT_NEAR(folds.radius, folds.length / (2 * pi * mean_share), 1e-12);
}

TEST(FoldScales, ClothWithoutBendingFoldsEverSmaller) {
    Material limp = material;
    limp.bending_scale = 0;
    EXPECT_EQ(fold_scales(sheet_model(0.2, limp, Vec3(0, -10, 0)), 0).front().radius, 0);
}

TEST(FoldScales, WeightBendsAStiffPlateAsACantilever) {
    Material plate = material; // D 100 N m
    plate.bending_scale = 1.2e6;
    const FoldScale bend = fold_scales(sheet_model(0.2, plate, Vec3(0, -10, 0)), 0).front();
    EXPECT_EQ(bend.cause, FoldCause::weight);
    EXPECT_NEAR(bend.radius, 2 * 100.0 / 20, 1e-9); // 2 D / (weight L^2)
}

TEST(FoldScales, HandlesThatComeNearerMakeOneBuckle) {
    Model model = sheet_model(0.2, material);
    add_edge_handles(model, move(Vec3(0.02, 0, 0)), move(Vec3(-0.02, 0, 0)));
    const auto scales = fold_scales(model, 0);
    const FoldScale* const buckle = find(scales, FoldCause::approach);
    ASSERT_NE(buckle, nullptr);
    EXPECT_NEAR(buckle->radius, 1 / (2 * pi * 2 * std::sqrt(0.04) * mean_share), 1e-9);
    EXPECT_EQ(find(scales, FoldCause::shear), nullptr);
}

TEST(FoldScales, HandlesThatShearOrTwistMakeWrinkles) {
    Model model = sheet_model(0.2, material);
    add_edge_handles(model, move(Vec3(0, 0, 0.1)), move(Vec3(0, 0, -0.1)));
    const auto scales = fold_scales(model, 0);
    const FoldScale* const wrinkles = find(scales, FoldCause::shear);
    ASSERT_NE(wrinkles, nullptr);
    const double strain = 0.2 / 2;
    EXPECT_NEAR(wrinkles->length, 2 * std::sqrt(pi) * std::pow(1.0 / 12 / (1000 * strain), 0.25), 1e-9);

    Model twisted = sheet_model(0.2, material);
    add_edge_handles(twisted, turn(Vec3(90, 0, 0)), turn(Vec3(-90, 0, 0)));
    ASSERT_NE(find(fold_scales(twisted, 0), FoldCause::shear), nullptr);
    EXPECT_LT(find(fold_scales(twisted, 0), FoldCause::shear)->radius, wrinkles->radius);
}

TEST(FoldScales, HandlesThatMoveAsOneDoNothing) {
    Model model = sheet_model(0.2, material);
    MotionTrack both = move(Vec3(1, 2, 3));
    both.rotate_deg.keys = {{0, Vec3::Zero()}, {1, Vec3(40, 300, -70)}};
    add_edge_handles(model, both, both);
    EXPECT_EQ(fold_scales(model, 0).size(), 1U);
}

TEST(FoldScales, ACurvedShellFoldsInRidgesWhenItIsCrushed) {
    const Material acrylic{1190, 3.2e9, 0.37, 1e-3, 1};
    Model model = shell_model(GeneratorShape::dome, acrylic);
    EXPECT_EQ(fold_scales(model, 0).front().cause, FoldCause::shape);
    Obstacle ball;
    append_part(model, sphere_mesh(0.02, 0.01), Vec3(0, 0.2, 0), ball.vertices, ball.faces);
    ball.motion = move(Vec3(0, -0.1, 0));
    model.obstacles.push_back(ball);
    const FoldScale ridges = fold_scales(model, 0).front();
    EXPECT_EQ(ridges.cause, FoldCause::crush);
    EXPECT_NEAR(ridges.length, ridge_radius(1e-3, 0.1), 0.05 * ridges.length);
    EXPECT_NEAR(ridges.radius, ridges.length / mean_share, 1e-9);
}

TEST(FoldScales, PressureHoldsAShellTautOrCollapsesIt) {
    const Material rubber{1100, 1e6, 0.45, 1e-3, 1}; // E (t/R)^2 = 100 Pa
    Model model = shell_model(GeneratorShape::sphere, rubber);
    Obstacle plate;
    append_part(model, sheet_mesh(0.1, 0.05), Vec3(0, 0.2, 0), plate.vertices, plate.faces);
    plate.motion = move(Vec3(0, -0.1, 0));
    model.obstacles.push_back(plate);
    const auto governing = [&](double pressure) {
        model.bodies[0].pressure = Track<double>(pressure);
        return fold_scales(model, 0).front().cause;
    };
    EXPECT_EQ(governing(0), FoldCause::crush);
    EXPECT_EQ(governing(500), FoldCause::shape);
    EXPECT_EQ(governing(-500), FoldCause::suction);
    model.obstacles.clear();
    EXPECT_EQ(governing(-30), FoldCause::shape);
}

TEST(LevelEstimates, AHungSheetIsTooCoarseUntilItsEdgesAreShort) {
    const Material felt{200, 2e6, 0.3, 3e-3, 1};
    Model model = sheet_model(0.03, felt, Vec3(0, -9.81, 0));
    const FoldScale folds = fold_scales(model, 0).front();
    ASSERT_EQ(folds.cause, FoldCause::weight);
    Context context;
    model.hierarchy = {4, 12};
    const Discretization discretization(model, 4, context);
    std::vector<Verdict> verdicts;
    for (int level = 0; level < 4; ++level) {
        const LevelEstimate estimate = estimate_level(discretization.mesh(level), {&folds, 1});
        EXPECT_NEAR(estimate.turn, estimate.median_edge / folds.radius, 1e-12);
        EXPECT_GT(estimate.long_edge, estimate.median_edge);
        EXPECT_EQ(estimate.verdict == Verdict::too_coarse, estimate.turn > most_turn);
        EXPECT_EQ(estimate.verdict == Verdict::sound, estimate.turn <= most_turn / 2);
        verdicts.push_back(estimate.verdict);
    }
    EXPECT_EQ(verdicts.front(), Verdict::too_coarse);
    EXPECT_EQ(verdicts.back(), Verdict::sound);
    EXPECT_TRUE(std::is_sorted(verdicts.rbegin(), verdicts.rend()));
}

TEST(LevelEstimates, EnoughVerticesMakeALevelJustFineEnough) {
    Model model = sheet_model(0.05, material);
    Context context;
    const Discretization discretization(model, 1, context);
    const HierarchyLevel& finest = discretization.mesh(0);
    const FoldScale folds{FoldCause::weight, 0.1 / most_turn, 0};
    EXPECT_EQ(enough_vertices(finest, {&folds, 1}), std::ceil(1.15 * 2 / std::sqrt(3) / 0.01));
    const FoldScale sharp{FoldCause::weight, 1e-4, 0};
    EXPECT_EQ(enough_vertices(finest, {&sharp, 1}), model.mesh.vertex_count());
    const FoldScale none{FoldCause::shape, std::numeric_limits<double>::infinity(), 0};
    EXPECT_EQ(enough_vertices(finest, {&none, 1}), 4);
}

} // namespace
