#include <plisse/energy/kirchhoff_love.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include <energy/assembled_fixtures.h>
#include <energy/shell_fixtures.h>
#include <energy/spline_grid.h>
#include <plisse/base/parallel.h>

namespace plisse {
namespace {

using testing::SplineGrid;

constexpr double thickness = 6.6e-4;

ShellSection denim(int points = 3) {
    return {denim_stable(), thickness, points};
}

/// A dented piece of a barrel, unevenly parametrised.
Positions curved_net(const SplineGrid& grid) {
    return grid.net([](double s, double t) {
        const double angle = 0.2 * s + 0.01 * s * s, height = 0.1 * t + 0.006 * t * t + 0.01 * s;
        const double radius = 0.5 - 0.2 * height * height + 0.01 * std::sin(s + 2 * t);
        return Vec3(radius * std::sin(angle), height, radius * std::cos(angle));
    });
}

struct Sheet {
    SplineGrid grid{3, 2};
    SurfaceBasis basis = grid.basis(3);
    Positions rest = grid.flat(0.3, 0.2);
};

TEST(KirchhoffLoveShell, DerivativesOfAFlatSheet) {
    Sheet sheet;
    for (const OrthotropicMaterial& material : {denim_table(), denim_stable(), isotropic_material(1e6, 0.3)})
        for (double size : {3e-4, 3e-3}) {
            KirchhoffLoveShell shell(sheet.basis, sheet.rest, {material, thickness, 3});
            const auto errors = testing::assembled_errors(shell, testing::perturbed(sheet.rest, size), 2e-7);
            EXPECT_LT(errors.gradient, 1e-7) << size;
            EXPECT_LT(errors.hessian, 1e-6) << size;
        }
}

TEST(KirchhoffLoveShell, DerivativesOfACurvedShell) {
    Sheet sheet;
    const Positions rest = curved_net(sheet.grid);
    std::vector<Vec3> warp;
    for (int face = 0; face < sheet.basis.face_count(); ++face)
        warp.push_back(Vec3(1, 0.3 * face, 0.2));
    KirchhoffLoveShell shell(sheet.basis, rest, {denim_stable(), 5e-3, 5}, warp);
    const auto errors = testing::assembled_errors(shell, testing::perturbed(rest, 2e-3), 2e-7);
    EXPECT_LT(errors.gradient, 1e-7);
    EXPECT_LT(errors.hessian, 1e-6);
}

/// The full matrix, sample point by sample point and control point by control point.
Eigen::MatrixXd slow_hessian(const SurfaceBasis& basis, const ShellSection& section, double scale, const Positions& x) {
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(x.size(), x.size());
    for (int face = 0; face < basis.face_count(); ++face)
        for (int p = 0; p < basis.point_count(); ++p) {
            const FaceStencil& stencil = basis.stencil(face);
            const auto control = basis.control_points(face);
            Eigen::MatrixXd spread = Eigen::MatrixXd::Zero(15, x.size()); // from control points to a jet
            for (std::size_t i = 0; i < control.size(); ++i) {
                const auto k = static_cast<Eigen::Index>(i);
                const double weights[5] = {stencil.du(k, p) / scale, stencil.dv(k, p) / scale,
                                           stencil.duu(k, p) / (scale * scale), stencil.duv(k, p) / (scale * scale),
                                           stencil.dvv(k, p) / (scale * scale)};
                for (int r = 0; r < 5; ++r)
                    for (int a = 0; a < 3; ++a)
                        spread(5 * a + r, 3 * control[i] + a) = weights[r];
            }
            const VecX jet = spread * as_vector(x);
            const ShellPoint point(Eigen::Map<const Eigen::Matrix<double, 5, 3>>(jet.data()).transpose(), Vec3::Zero());
            const auto tangent = section.tangent(point.strain(), point.curvature(), false);
            sum += basis.weight(p) * scale * scale * spread.transpose() * point.hessian(tangent, false) * spread;
        }
    return sum;
}

TEST(KirchhoffLoveShell, AssemblesWhatTheSlowSumGives) {
    const Sheet sheet;
    const Positions x = testing::perturbed(sheet.rest, 2e-3);
    KirchhoffLoveShell shell(sheet.basis, sheet.rest, denim());
    const Eigen::MatrixXd fast = testing::dense_hessian(shell, x, false);
    const Eigen::MatrixXd slow = slow_hessian(sheet.basis, denim(), 0.1, x);
    EXPECT_LT((fast - slow).norm(), 1e-12 * slow.norm());
}

/// The basis with one more control point in each face, which has no weight.
SurfaceBasis padded(const SplineGrid& grid, const SurfaceBasis& basis) {
    FaceStencil stencil = basis.stencil(0);
    for (Eigen::MatrixXd* m : {&stencil.value, &stencil.du, &stencil.dv, &stencil.duu, &stencil.duv, &stencil.dvv}) {
        m->conservativeResize(17, Eigen::NoChange);
        m->row(16).setZero();
    }
    SurfaceBasis more(grid.vertex_count(), basis.weights());
    const int kind = more.add_kind(stencil);
    for (int j = 0; j < grid.ny; ++j)
        for (int i = 0; i < grid.nx; ++i) {
            std::vector<int> control = grid.control_points(i, j);
            control.push_back(grid.vertex(i == 0 ? grid.nx + 2 : 0, 0));
            more.add_element(kind, control);
        }
    return more;
}

TEST(KirchhoffLoveShell, FacesMayHaveAnyNumberOfControlPoints) {
    const Sheet sheet;
    const Positions x = testing::perturbed(sheet.rest, 2e-3);
    const SurfaceBasis more = padded(sheet.grid, sheet.basis);
    KirchhoffLoveShell shell(sheet.basis, sheet.rest, denim()), other(more, sheet.rest, denim());
    EXPECT_NEAR(other.value(x) / shell.value(x), 1, 1e-14);
    const VecX gradient = testing::gradient_of(shell, as_vector(x));
    EXPECT_LT((testing::gradient_of(other, as_vector(x)) - gradient).norm(), 1e-13 * gradient.norm());
    for (bool project : {false, true}) {
        const Eigen::MatrixXd hessian = testing::dense_hessian(shell, x, project);
        EXPECT_LT((testing::dense_hessian(other, x, project) - hessian).norm(), 1e-13 * hessian.norm());
    }
}

TEST(KirchhoffLoveShell, GivesTheSameBitsForAnyNumberOfThreads) {
    const SplineGrid grid{20, 17};
    const SurfaceBasis basis = grid.basis(2);
    const Positions rest = grid.flat(1, 1), x = testing::perturbed(rest, 1e-3);
    KirchhoffLoveShell shell(basis, rest, denim());
    std::vector<double> values;
    std::vector<VecX> gradients;
    std::vector<std::vector<Mat3>> hessians;
    for (int threads : {1, 2}) {
        const ThreadLimit limit(threads);
        values.push_back(shell.value(x));
        gradients.push_back(testing::gradient_of(shell, as_vector(x)));
        hessians.push_back(testing::assembled_hessian(shell, x, false).blocks());
    }
    EXPECT_EQ(values[0], values[1]);
    EXPECT_EQ(gradients[0], gradients[1]);
    EXPECT_EQ(hessians[0], hessians[1]);
}

Positions moved_rigidly(const Positions& x, Random& random) {
    const Mat3 rotation = testing::random_rotation(random);
    return (rotation * x).colwise() + Vec3(0.3, -0.7, 1.1);
}

TEST(KirchhoffLoveShell, RigidMotionsCostNothing) {
    Random random(2);
    const SplineGrid grid{8, 8};
    const SurfaceBasis basis = grid.basis(3);
    const Positions flat = grid.flat(1, 1), curved = curved_net(grid);
    for (const Positions& rest : {flat, curved}) {
        const KirchhoffLoveShell shell(basis, rest, denim());
        for (int k = 0; k < 3; ++k) {
            const Positions x = moved_rigidly(rest, random);
            EXPECT_LT(std::abs(shell.value(x)), 1e-10);
            EXPECT_LT(testing::gradient_of(shell, as_vector(x)).cwiseAbs().maxCoeff(), 1e-8);
        }
        const Positions bent = testing::perturbed(rest, 1e-3);
        EXPECT_NEAR(shell.value(moved_rigidly(bent, random)), shell.value(bent), 1e-10);
        EXPECT_GT(shell.value(bent), 1e-4);
    }
}

TEST(KirchhoffLoveShell, CurvedRestShapeIsAtRest) {
    const SplineGrid grid{6, 5};
    const SurfaceBasis basis = grid.basis(3);
    const Positions cylinder =
        grid.net([](double s, double t) { return Vec3(0.4 * std::sin(0.25 * s), 0.1 * t, 0.4 * std::cos(0.25 * s)); });
    const KirchhoffLoveShell shell(basis, cylinder, denim());
    EXPECT_LT(shell.value(cylinder), 1e-25);
    EXPECT_LT(testing::gradient_of(shell, as_vector(cylinder)).cwiseAbs().maxCoeff(), 1e-10);
    // Flattening it costs energy.
    EXPECT_GT(shell.value(grid.flat(0.6, 0.5)), 1e-6);
}

TEST(KirchhoffLoveShell, RollingAFlatSheetCostsPlateEnergy) {
    const double young = 1e6, poisson = 0.3, radius = 0.2, angle = 0.1;
    const SplineGrid grid{10, 4};
    const SurfaceBasis basis = grid.basis(3);
    const Positions rest = grid.flat(10 * radius * angle, 0.1);
    // Control points so far out that the faces' corners lie on the circle.
    const double out = radius * 3 / (2 + std::cos(angle));
    const Positions rolled = grid.net(
        [&](double s, double t) { return Vec3(out * std::sin(angle * s), 0.025 * t, out * std::cos(angle * s)); });
    const double h = 2e-2; // so thick that the faces' small stretch does not count
    const KirchhoffLoveShell shell(basis, rest, {isotropic_material(young, poisson), h, 3});
    const double rigidity = young * h * h * h / (12 * (1 - poisson * poisson));
    EXPECT_NEAR(shell.rest_area(), 10 * radius * angle * 0.1, 1e-14);
    EXPECT_NEAR(shell.value(rolled) / (rigidity / 2 / (radius * radius) * shell.rest_area()), 1, 1e-4);
    const auto [strain, curvature] = shell.deformation(17, 4, rolled);
    EXPECT_LT(strain.norm(), 1e-5);
    EXPECT_LT((curvature - Vec3(1 / radius, 0, 0)).norm(), 1e-2);
}

TEST(KirchhoffLoveShell, UniformStretchCostsItsDensity) {
    const SplineGrid grid{5, 4};
    const SurfaceBasis basis = grid.basis(2);
    const Positions rest = grid.flat(0.5, 0.3);
    Mat3 stretch = Mat3::Identity();
    stretch.topLeftCorner<2, 2>() << 1.05, 0.02, 0.03, 0.97;
    const Mat3 strain = (stretch.transpose() * stretch - Mat3::Identity()) / 2;
    for (double turn : {0.0, 0.4, std::numbers::pi / 2}) {
        const Vec3 warp(std::cos(turn), std::sin(turn), 0), weft(-std::sin(turn), std::cos(turn), 0);
        const Vec3 in_material(warp.dot(strain * warp), weft.dot(strain * weft), warp.dot(strain * weft));
        // What stands on the sheet does not count.
        const KirchhoffLoveShell shell(basis, rest, denim(), std::vector<Vec3>{2 * warp + Vec3(0, 0, 0.5)});
        EXPECT_NEAR(shell.value(stretch * rest) / (0.15 * thickness * denim_stable().energy(in_material)), 1, 1e-12);
    }
}

TEST(KirchhoffLoveShell, UprightWarpGivesWayToTheNextAxis) {
    const SplineGrid grid{3, 3};
    const SurfaceBasis basis = grid.basis(2);
    const Positions rest = grid.net([](double s, double t) { return Vec3(0, 0.1 * s, 0.1 * t); });
    Positions x = rest;
    x.row(1) *= 1.1;
    const KirchhoffLoveShell by_default(basis, rest, denim());
    EXPECT_EQ(by_default.value(x), KirchhoffLoveShell(basis, rest, denim(), std::vector{Vec3(0, 1, 0)}).value(x));
    EXPECT_GT(
        std::abs(by_default.value(x) / KirchhoffLoveShell(basis, rest, denim(), std::vector{Vec3(0, 0, 1)}).value(x) -
                 1),
        0.1);
}

TEST(KirchhoffLoveShell, ParametrisationDropsOut) {
    const SplineGrid grid{4, 3};
    const Positions rest = curved_net(grid), x = testing::perturbed(rest, 1e-3);
    const SurfaceBasis plain = grid.basis(3);
    const SurfaceBasis other = grid.basis(3, [](int point) {
        testing::Reparametrisation change;
        change.first << 0.2 + 0.1 * point, -1.1, 0.9, 0.3; // turned by about a right angle
        change.u_second << 0.4, -0.3, -0.3, 0.1 * point;
        change.v_second << -0.2, 0.5, 0.5, 0.7;
        return change;
    });
    KirchhoffLoveShell shell(plain, rest, {denim_stable(), 5e-3, 3});
    KirchhoffLoveShell same(other, rest, {denim_stable(), 5e-3, 3});
    EXPECT_NEAR(same.rest_area() / shell.rest_area(), 1, 1e-13);
    EXPECT_NEAR(same.value(x) / shell.value(x), 1, 1e-11);
    const Eigen::MatrixXd hessian = testing::dense_hessian(shell, x, false);
    EXPECT_LT((testing::dense_hessian(same, x, false) - hessian).norm(), 1e-10 * hessian.norm());
}

TEST(KirchhoffLoveShell, IsInfiniteWhereTheSurfaceHasNoNormal) {
    const Sheet sheet;
    const KirchhoffLoveShell shell(sheet.basis, sheet.rest, denim());
    constexpr double infinity = std::numeric_limits<double>::infinity();
    EXPECT_EQ(shell.value(Positions::Zero(3, sheet.rest.cols())), infinity);
    Positions line = sheet.rest;
    line.row(1).setZero();
    EXPECT_EQ(shell.value(line), infinity);
    Positions far = sheet.rest;
    far(0, 14) = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(shell.value(far), infinity);
    EXPECT_EQ(shell.value(sheet.rest * 1e200), infinity);
}

TEST(KirchhoffLoveShell, ProjectedHessianIsPositiveAndTheTrueOneAtRest) {
    const Sheet sheet;
    KirchhoffLoveShell shell(sheet.basis, sheet.rest, denim());
    Positions x = testing::perturbed(sheet.rest, 1e-3);
    x.topRows<2>() *= 0.95;
    EXPECT_LT(testing::lowest_eigenvalue(testing::dense_hessian(shell, x, false)), -0.1);
    const Eigen::MatrixXd projected = testing::dense_hessian(shell, x, true);
    EXPECT_GT(testing::lowest_eigenvalue(projected), -1e-13 * projected.norm());
    const Eigen::MatrixXd at_rest = testing::dense_hessian(shell, sheet.rest, false);
    EXPECT_LT((testing::dense_hessian(shell, sheet.rest, true) - at_rest).norm(), 1e-12 * at_rest.norm());
}

} // namespace
} // namespace plisse
