#include <plisse/subdivide/subdivide.h>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include <plisse/base/random.h>
#include <plisse/decimate/hierarchy_statistics.h>
#include <plisse/decimate/level_attributes.h>
#include <plisse/decimate/level_prolongation.h>
#include <plisse/mesh/connectivity.h>
#include <plisse/mesh/generate.h>

namespace plisse {
namespace {

std::size_t at(int index) {
    return static_cast<std::size_t>(index);
}

SubdivisionInput input_of(const TriangleMesh& mesh) {
    const auto count = at(mesh.vertex_count());
    return {mesh.positions,
            {mesh.faces, std::vector<int>(count, 0), std::vector<int>(count, -1)},
            {},
            [](int a, int b) { return a == b ? a : -1; }};
}

TriangleMesh generated(GeneratorShape shape, double edge_length) {
    GeneratorOptions options;
    options.shape = shape;
    options.edge_length = edge_length;
    return generate_mesh(options);
}

Positions waved(const Positions& x) {
    Positions y = x;
    for (Eigen::Index i = 0; i < x.cols(); ++i)
        y.col(i) += 0.05 * (7 * x.col(i)).array().sin().matrix();
    return y;
}

class Subdivided : public testing::TestWithParam<GeneratorShape> {
protected:
    Subdivided() : hierarchy(subdivide(input_of(generated(GetParam(), 0.25)), 3)) {}
    Hierarchy hierarchy;
};

TEST_P(Subdivided, KeepsTheTopology) {
    const auto counts = [&](int level) {
        const HierarchyLevel& mesh = hierarchy.levels[at(level)];
        return count_topology(static_cast<int>(mesh.rest.cols()), mesh.faces);
    };
    for (int level = 1; level < 3; ++level) {
        EXPECT_TRUE(counts(level).same_topology(counts(0)));
        EXPECT_EQ(counts(level).faces, 4 * counts(level - 1).faces);
        const Connectivity connectivity(counts(level - 1).vertices, hierarchy.levels[at(level - 1)].faces);
        EXPECT_EQ(counts(level).vertices, counts(level - 1).vertices + connectivity.edge_count());
    }
}

TEST_P(Subdivided, ReachesRestFromRestByEveryOperator) {
    using P = ProlongationOperator;
    for (int level = 0; level < 2; ++level)
        for (P kind : {P::loop, P::shell, P::blend}) {
            const HierarchyLevel &mesh = hierarchy.levels[at(level)], &next = hierarchy.levels[at(level + 1)];
            const Positions finest = prolongation_to_finest(hierarchy, level, kind).apply(mesh.rest);
            EXPECT_LT((finest - hierarchy.finest().rest).cwiseAbs().maxCoeff(), 1e-14);
            const Positions step = prolongation_to_next(hierarchy, level, kind).apply(mesh.rest);
            EXPECT_LT((step - next.rest).cwiseAbs().maxCoeff(), 1e-14);
        }
}

TEST_P(Subdivided, GoesToTheFinestByTheLevelsBetween) {
    for (ProlongationOperator kind : {ProlongationOperator::loop, ProlongationOperator::intrinsic}) {
        const Positions x = waved(hierarchy.levels[0].rest);
        const Positions middle = prolongation_to_next(hierarchy, 0, kind).apply(x);
        const Positions far = prolongation_to_finest(hierarchy, 0, kind).apply(x);
        EXPECT_LT((prolongation_to_next(hierarchy, 1, kind).apply(middle) - far).cwiseAbs().maxCoeff(), 1e-14);
    }
}

TEST_P(Subdivided, PullsForcesAndValuesBack) {
    Random random(2);
    const Prolongation p = prolongation_to_finest(hierarchy, 0, ProlongationOperator::loop);
    const Positions x = waved(hierarchy.levels[0].rest), d = waved(x) - x;
    const Positions g = Positions::NullaryExpr(3, p.fine_count(), [&] { return random.uniform(-1, 1); });
    const double h = 1e-3; // the operator is linear
    const Positions change = (p.apply(x + h * d) - p.apply(x - h * d)) / (2 * h);
    EXPECT_NEAR(change.cwiseProduct(g).sum(), p.pull_back(x, g).cwiseProduct(d).sum(), 1e-10);
    EXPECT_LT((p.pull_back(x, g) - p.pull_back_lagged(g)).cwiseAbs().maxCoeff(), 1e-13);
    const ProlongationJacobian jacobian = p.jacobian(x);
    for (int v = 0; v < p.fine_count(); ++v) {
        Vec3 moved = Vec3::Zero();
        const auto stencil = p.stencils().of(v);
        for (std::size_t k = 0; k < stencil.size(); ++k)
            moved += jacobian.rows(v).middleCols<3>(static_cast<Eigen::Index>(3 * k)) * d.col(stencil[k]);
        EXPECT_LT((moved - change.col(v)).norm(), 1e-12);
    }
    const VecX masses = VecX::NullaryExpr(p.fine_count(), [&] { return random.uniform(0.1, 1); });
    EXPECT_GT(p.pull_back_values(masses).minCoeff(), 0);
    EXPECT_NEAR(p.pull_back_values(masses).sum(), masses.sum(), 1e-10);
}

TEST_P(Subdivided, NumbersTheInputsVerticesFirst) {
    for (int level = 0; level < 3; ++level) {
        const HierarchyLevel& mesh = hierarchy.levels[at(level)];
        for (std::size_t v = 0; v < mesh.vertex_ids.size(); ++v)
            EXPECT_EQ(mesh.vertex_ids[v], static_cast<int>(v));
        for (std::size_t f = 0; f < mesh.face_ids.size(); ++f)
            EXPECT_EQ(mesh.face_ids[f], static_cast<int>(f >> (2 * level)));
    }
}

INSTANTIATE_TEST_SUITE_P(Shapes, Subdivided,
                         testing::Values(GeneratorShape::sheet, GeneratorShape::sphere, GeneratorShape::annulus,
                                         GeneratorShape::cylinder));

TEST(Subdivide, LeavesAFlatSheetFlatAndAsLarge) {
    const Hierarchy hierarchy = subdivide(input_of(generated(GeneratorShape::sheet, 0.2)), 3);
    for (const HierarchyLevel& level : hierarchy.levels) {
        EXPECT_EQ(level.rest.row(1).cwiseAbs().maxCoeff(), 0);
        double area = 0;
        for (const Face& face : level.faces) {
            const Vec3 a = level.rest.col(face[0]), b = level.rest.col(face[1]), c = level.rest.col(face[2]);
            const double twice = (b - a).cross(c - a).y();
            EXPECT_GT(twice, 0);
            area += 0.5 * twice;
        }
        EXPECT_NEAR(area, 1, 1e-12);
    }
}

/// A vertex tends to (w x + the sum of its neighbours) / (w + n), w = 3 / (8 b) (Loop 1987).
TEST(Subdivide, TendsToLoopsLimitSurface) {
    const TriangleMesh mesh = generated(GeneratorShape::sphere, 0.6);
    const Hierarchy hierarchy = subdivide(input_of(mesh), 6);
    const Connectivity connectivity(mesh.vertex_count(), mesh.faces);
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        Vec3 sum = Vec3::Zero();
        int n = 0;
        for (const Edge& edge : connectivity.edges())
            if (edge[0] == v || edge[1] == v) {
                sum += mesh.positions.col(edge[0] == v ? edge[1] : edge[0]);
                ++n;
            }
        const double c = 3.0 / 8 + std::cos(2 * std::numbers::pi / n) / 4, b = (5.0 / 8 - c * c) / n;
        const double w = 3 / (8 * b);
        const Vec3 limit = (w * mesh.positions.col(v) + sum) / (w + n);
        EXPECT_LT((hierarchy.finest().rest.col(v) - limit).norm(), 1e-3);
        EXPECT_GT((mesh.positions.col(v) - limit).norm(), 0.03);
    }
}

TEST(Subdivide, KeepsPartsTogether) {
    TriangleMesh mesh = generated(GeneratorShape::sheet, 0.5);
    const int one = mesh.vertex_count();
    SubdivisionInput input = input_of(mesh);
    input.rest.resize(3, 2 * one);
    input.rest << mesh.positions, mesh.positions.colwise() + Vec3::UnitY();
    for (int v = 0; v < one; ++v) {
        input.surface.part.push_back(1);
        input.surface.label.push_back(-1);
    }
    for (const Face& face : mesh.faces)
        input.surface.faces.push_back({face[0] + one, face[1] + one, face[2] + one});
    const Hierarchy hierarchy = subdivide(input, 3);
    const HierarchyLevel& finest = hierarchy.finest();
    EXPECT_TRUE(std::is_sorted(finest.part.begin(), finest.part.end()));
    for (const HierarchyLevel& level : hierarchy.levels) {
        EXPECT_TRUE(std::is_sorted(level.vertex_ids.begin(), level.vertex_ids.end()));
        for (std::size_t v = 0; v < level.part.size(); ++v)
            EXPECT_EQ(level.rest(1, static_cast<Eigen::Index>(v)), level.part[v]);
    }
    const int half = static_cast<int>(finest.rest.cols()) / 2;
    EXPECT_EQ(finest.rest.leftCols(half).row(0), finest.rest.rightCols(half).row(0));
}

TEST(Subdivide, CarriesAttributesToFinerLevels) {
    const TriangleMesh mesh = generated(GeneratorShape::sheet, 0.25);
    const Hierarchy hierarchy = subdivide(input_of(mesh), 3);
    using Domain = MeshAttribute::Domain;
    MeshAttribute of_vertices{"u", Domain::vertex, 1, {}};
    MeshAttribute of_faces{"panel", Domain::face, 1, {}, MeshAttribute::Number::int32};
    MeshAttribute of_corners{"uv", Domain::corner, 2, {}}; // every face an island of its own
    for (int v = 0; v < mesh.vertex_count(); ++v)
        of_vertices.values.push_back(mesh.positions(0, v));
    for (int f = 0; f < mesh.face_count(); ++f) {
        of_faces.values.push_back(f);
        for (int v : mesh.faces[at(f)])
            of_corners.values.insert(of_corners.values.end(), {mesh.positions(0, v) + 10 * f, mesh.positions(2, v)});
    }
    const auto attributes = attributes_on(hierarchy, 2, {of_vertices, of_faces, of_corners});
    EXPECT_EQ(attributes_on(hierarchy, 0, {of_faces})[0].values, of_faces.values);
    const HierarchyLevel& level = hierarchy.finest();
    // Places between the input's vertices: Loop's rule would move vertices about within the sheet.
    const Positions places =
        prolongation_to_finest(hierarchy, 0, ProlongationOperator::intrinsic).apply(hierarchy.levels[0].rest);
    for (Eigen::Index v = 0; v < places.cols(); ++v)
        EXPECT_NEAR(attributes[0].values[static_cast<std::size_t>(v)], places(0, v), 1e-14);
    for (std::size_t f = 0; f < level.faces.size(); ++f) {
        EXPECT_EQ(attributes[1].values[f], static_cast<double>(f / 16));
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3 place = places.col(level.faces[f][k]);
            EXPECT_NEAR(attributes[2].values[6 * f + 2 * k], place.x() + 10 * static_cast<double>(f / 16), 1e-12);
            EXPECT_NEAR(attributes[2].values[6 * f + 2 * k + 1], place.z(), 1e-14);
        }
    }
}

} // namespace
} // namespace plisse
