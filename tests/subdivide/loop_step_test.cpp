#include <plisse/subdivide/loop_step.h>

#include <gtest/gtest.h>

#include <algorithm>

#include <plisse/mesh/generate.h>

namespace plisse {
namespace {

LabelledSurface free_surface(std::vector<Face> faces, int vertex_count) {
    const auto count = static_cast<std::size_t>(vertex_count);
    return {std::move(faces), std::vector<int>(count, 0), std::vector<int>(count, -1)};
}

LabelledSurface generated(GeneratorShape shape, double edge_length, Pattern pattern = Pattern::irregular) {
    GeneratorOptions options;
    options.shape = shape;
    options.edge_length = edge_length;
    options.pattern = pattern;
    const TriangleMesh mesh = generate_mesh(options);
    return free_surface(mesh.faces, mesh.vertex_count());
}

LoopStep step_of(const LabelledSurface& surface, const std::vector<std::uint8_t>& kept_part = {}) {
    return loop_step(surface, kept_part, [](int a, int b) { return a == b ? a : -1; });
}

/// n faces around vertex 0.
LabelledSurface fan(int n) {
    std::vector<Face> faces;
    for (int i = 0; i < n; ++i)
        faces.push_back({0, 1 + i, 1 + (i + 1) % n});
    return free_surface(faces, n + 1);
}

/// The number of the vertex in the middle of an edge.
int between(const LoopStep& step, const LabelledSurface& coarse, int a, int b) {
    for (std::size_t f = 0; f < step.parent.size(); ++f)
        for (int k = 0; k < 3; ++k) {
            Vec3 weights = step.corners[f].col(k);
            const Face& face = coarse.faces[static_cast<std::size_t>(step.parent[f])];
            for (std::size_t i = 0; i < 3; ++i)
                if (face[i] == a || face[i] == b)
                    weights[static_cast<Eigen::Index>(i)] -= 0.5;
            if (weights.isZero(0))
                return step.fine.faces[f][static_cast<std::size_t>(k)];
        }
    return -1;
}

TEST(LoopStep, TakesMeansOfWhatIsAround) {
    for (GeneratorShape shape : {GeneratorShape::sheet, GeneratorShape::sphere, GeneratorShape::annulus})
        for (Pattern pattern : {Pattern::irregular, Pattern::regular}) {
            const LoopStep step = step_of(generated(shape, 0.1, pattern));
            const VecX sums = step.weights * VecX::Ones(step.weights.cols());
            EXPECT_LT((sums.array() - 1).abs().maxCoeff(), 1e-15);
            for (int row = 0; row < step.weights.rows(); ++row)
                for (ProlongationWeights::InnerIterator entry(step.weights, row); entry; ++entry)
                    EXPECT_GT(entry.value(), 0);
        }
}

TEST(LoopStep, HasLoopsWeightsWhereTheSurfaceIsSmooth) {
    const LabelledSurface regular = fan(6);
    const LoopStep step = step_of(regular);
    EXPECT_NEAR(step.weights.coeff(0, 0), 5.0 / 8, 1e-15);
    for (int v = 1; v <= 6; ++v)
        EXPECT_NEAR(step.weights.coeff(0, v), 1.0 / 16, 1e-15);
    const int spoke = between(step, regular, 0, 3);
    EXPECT_EQ(step.weights.coeff(spoke, 0), 3.0 / 8);
    EXPECT_EQ(step.weights.coeff(spoke, 3), 3.0 / 8);
    EXPECT_EQ(step.weights.coeff(spoke, 2), 1.0 / 8);
    EXPECT_EQ(step.weights.coeff(spoke, 4), 1.0 / 8);
    const LoopStep corner = step_of(fan(3));
    EXPECT_NEAR(corner.weights.coeff(0, 0), 7.0 / 16, 1e-15);
    EXPECT_NEAR(corner.weights.coeff(0, 2), 3.0 / 16, 1e-15);
}

TEST(LoopStep, KeepsTheBoundaryAsItIs) {
    const LabelledSurface coarse = fan(5);
    const LoopStep step = step_of(coarse);
    for (int v = 1; v <= 5; ++v) {
        EXPECT_EQ(step.weights.row(v).nonZeros(), 1);
        EXPECT_EQ(step.weights.coeff(v, v), 1);
        const int next = 1 + v % 5;
        const int middle = between(step, coarse, v, next);
        EXPECT_EQ(step.weights.row(middle).nonZeros(), 2);
        EXPECT_EQ(step.weights.coeff(middle, v), 0.5);
        EXPECT_EQ(step.weights.coeff(middle, next), 0.5);
    }
}

TEST(LoopStep, KeepsWhatIsPinned) {
    LabelledSurface coarse = generated(GeneratorShape::sphere, 0.3);
    const Face pinned = coarse.faces[7];
    for (int v : pinned)
        coarse.label[static_cast<std::size_t>(v)] = 4;
    const int other = coarse.faces[20][0];
    ASSERT_EQ(std::count(pinned.begin(), pinned.end(), other), 0);
    coarse.label[static_cast<std::size_t>(other)] = 2;
    const LoopStep step = step_of(coarse);
    for (std::size_t k = 0; k < 3; ++k) {
        const int a = pinned[k], b = pinned[(k + 1) % 3];
        EXPECT_EQ(step.weights.coeff(step.fine_number[static_cast<std::size_t>(a)], a), 1);
        const int middle = between(step, coarse, a, b);
        EXPECT_EQ(step.fine.label[static_cast<std::size_t>(middle)], 4);
        EXPECT_EQ(step.weights.coeff(middle, a), 0.5);
        EXPECT_EQ(step.weights.coeff(middle, b), 0.5);
    }
    EXPECT_EQ(step.weights.coeff(step.fine_number[static_cast<std::size_t>(other)], other), 1);
    EXPECT_EQ(std::count(step.fine.label.begin(), step.fine.label.end(), 4), 6);
    EXPECT_EQ(std::count(step.fine.label.begin(), step.fine.label.end(), 2), 1);
}

TEST(LoopStep, KeepsAnEdgeOfThreeFaces) {
    const LabelledSurface coarse = free_surface({{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}, 5);
    const LoopStep step = step_of(coarse);
    EXPECT_EQ(step.weights.rows(), 5 + 7);
    const int middle = between(step, coarse, 0, 1);
    EXPECT_EQ(step.weights.coeff(middle, 0), 0.5);
    EXPECT_EQ(step.weights.coeff(middle, 1), 0.5);
    EXPECT_EQ(step.weights.coeff(0, 0), 1);
}

TEST(LoopStep, LeavesKeptPartsAndUnusedVerticesAlone) {
    LabelledSurface coarse = free_surface({{0, 1, 2}, {4, 5, 6}}, 7); // 3 is on no face
    coarse.part = {0, 0, 0, 0, 1, 1, 1};
    const LoopStep step = step_of(coarse, {0, 1});
    EXPECT_EQ(step.fine.part, (std::vector{0, 0, 0, 0, 0, 0, 0, 1, 1, 1}));
    EXPECT_EQ(step.fine_number, (std::vector{0, 1, 2, 3, 7, 8, 9}));
    EXPECT_EQ(step.fine.faces, (std::vector<Face>{{0, 4, 5}, {1, 6, 4}, {2, 5, 6}, {4, 6, 5}, {7, 8, 9}}));
    EXPECT_EQ(step.parent, (std::vector{0, 0, 0, 0, 1}));
    EXPECT_EQ(step.weights.coeff(3, 3), 1);
    EXPECT_EQ(step.weights.coeff(8, 5), 1);
}

} // namespace
} // namespace plisse
