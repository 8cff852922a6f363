#include <plisse/subdivide/surface_basis.h>

#include <gtest/gtest.h>

#include <opensubdiv/bfr/refinerSurfaceFactory.h>
#include <opensubdiv/far/topologyDescriptor.h>
#include <opensubdiv/far/topologyRefinerFactory.h>

#include <plisse/subdivide/face_ring.h>
#include <plisse/subdivide/limit_points.h>

#include "quad_samples.h"

namespace plisse {
namespace {

const std::array<Eigen::MatrixXd FaceStencil::*, 6> all_weights = {
    &FaceStencil::value, &FaceStencil::du, &FaceStencil::dv, &FaceStencil::duu, &FaceStencil::duv, &FaceStencil::dvv};

TEST(Quadrature, IsExactForPolynomials) {
    for (int count : {2, 3, 4}) {
        const auto line = gauss_on_line(count);
        for (int degree = 0; degree < 2 * count; ++degree) {
            double sum = 0;
            for (std::size_t i = 0; i < line.points.size(); ++i)
                sum += line.weights[i] * std::pow(line.points[i], degree);
            EXPECT_NEAR(sum, 1.0 / (degree + 1), 1e-15);
        }
        const auto square = gauss_on_square(count);
        double moment = 0, total = 0;
        for (std::size_t i = 0; i < square.points.size(); ++i) {
            moment += square.weights[i] * square.points[i].x() * std::pow(square.points[i].y(), 3);
            total += square.weights[i];
        }
        EXPECT_NEAR(total, 1, 1e-15);
        EXPECT_NEAR(moment, 1.0 / 8, 1e-15);
        EXPECT_LT(square.points[0].x(), square.points[1].x()); // u runs first
    }
}

/// Truncated powers: another form of the same pieces.
double cardinal_bspline(double x) {
    double sum = 0;
    const std::array<double, 5> binomial = {1, -4, 6, -4, 1};
    for (int k = 0; k < 5; ++k)
        sum += binomial[static_cast<std::size_t>(k)] * std::pow(std::max(0.0, x + 2 - k), 3) / 6;
    return sum;
}

TEST(SurfaceBasis, IsTheBicubicSplineOnOrdinaryFaces) {
    const QuadMesh quads = flat_grid(4, 3);
    const auto& [mesh, p] = with_ghost_ring(quads);
    for (int gauss : {2, 3, 4}) {
        const SurfaceBasis basis = surface_basis(mesh, gauss);
        const auto points = gauss_on_square(gauss).points;
        EXPECT_EQ(basis.kind_count(), 1);
        ASSERT_EQ(basis.face_count(), 12);
        for (int f = 0; f < basis.face_count(); ++f) {
            ASSERT_EQ(basis.control_points(f).size(), 16U);
            const Vec3 origin = quads.positions.col(quads.faces[static_cast<std::size_t>(f)][0]);
            for (int i = 0; i < basis.point_count(); ++i)
                for (int k = 0; k < 16; ++k) {
                    const Vec3 centre = p.col(basis.control_points(f)[static_cast<std::size_t>(k)]) - origin;
                    const Vec2& at = points[static_cast<std::size_t>(i)];
                    EXPECT_NEAR(basis.stencil(f).value(k, i),
                                cardinal_bspline(at.x() - centre.x()) * cardinal_bspline(at.y() - centre.y()), 1e-14);
                }
        }
    }
}

TEST(SurfaceBasis, HasDerivativesOfItsValues) {
    constexpr double h = 1e-4;
    for (const std::array<int, 4>& valence :
         {std::array{4, 4, 4, 4}, std::array{3, 4, 4, 4}, std::array{4, 5, 4, 3}, std::array{8, 3, 6, 7}})
        for (const Vec2& at : {Vec2(0.21, 0.33), Vec2(0.8, 0.07), Vec2(0.6, 0.93)}) {
            const std::vector<Vec2> around = {at, at + Vec2(h, 0), at - Vec2(h, 0), at + Vec2(0, h), at - Vec2(0, h)};
            const FaceStencil s = face_stencil(valence, around);
            const auto u = [&](const Eigen::MatrixXd& m) -> VecX { return (m.col(1) - m.col(2)) / (2 * h); };
            const auto v = [&](const Eigen::MatrixXd& m) -> VecX { return (m.col(3) - m.col(4)) / (2 * h); };
            EXPECT_LT((u(s.value) - s.du.col(0)).cwiseAbs().maxCoeff(), 3e-7);
            EXPECT_LT((v(s.value) - s.dv.col(0)).cwiseAbs().maxCoeff(), 3e-7);
            EXPECT_LT((u(s.du) - s.duu.col(0)).cwiseAbs().maxCoeff(), 1e-10);
            EXPECT_LT((v(s.du) - s.duv.col(0)).cwiseAbs().maxCoeff(), 1e-6);
            EXPECT_LT((u(s.dv) - s.duv.col(0)).cwiseAbs().maxCoeff(), 1e-6);
            EXPECT_LT((v(s.dv) - s.dvv.col(0)).cwiseAbs().maxCoeff(), 1e-10);
        }
}

/// OpenSubdiv's own limit surfaces, refined so far that they are exact at these points.
TEST(SurfaceBasis, AgreesWithTheLibrary) {
    namespace osd = OpenSubdiv;
    for (const auto& [name, quads, ordinary] : quad_samples()) {
        const ControlMesh mesh = catmull_clark_step(with_ghost_ring(quads).mesh).fine;
        const std::vector<int> corner_counts(mesh.faces.size(), 4);
        osd::Far::TopologyDescriptor descriptor;
        descriptor.numVertices = mesh.vertex_count;
        descriptor.numFaces = static_cast<int>(mesh.faces.size());
        descriptor.numVertsPerFace = corner_counts.data();
        descriptor.vertIndicesPerFace = mesh.faces.front().data();
        osd::Sdc::Options options;
        options.SetVtxBoundaryInterpolation(osd::Sdc::Options::VTX_BOUNDARY_NONE);
        using Refiners = osd::Far::TopologyRefinerFactory<osd::Far::TopologyDescriptor>;
        const std::unique_ptr<osd::Far::TopologyRefiner> refiner(
            Refiners::Create(descriptor, Refiners::Options(osd::Sdc::SCHEME_CATMARK, options)));
        using Surfaces = osd::Bfr::RefinerSurfaceFactory<>;
        const Surfaces factory(*refiner, Surfaces::Options().SetApproxLevelSmooth(5));
        const SurfaceBasis basis = surface_basis(mesh, 4);
        const auto points = gauss_on_square(4).points;
        for (int f = 0; f < basis.face_count(); ++f) {
            const std::unique_ptr<osd::Bfr::Surface<double>> surface(factory.CreateVertexSurface<double>(f));
            ASSERT_TRUE(surface) << name;
            const auto count = static_cast<std::size_t>(surface->GetNumControlPoints());
            std::vector<int> indices(count);
            surface->GetControlPointIndices(indices.data());
            for (int i = 0; i < basis.point_count(); ++i) {
                std::array<std::vector<double>, 6> weights;
                weights.fill(std::vector<double>(count));
                surface->EvaluateStencil(points[static_cast<std::size_t>(i)].data(), weights[0].data(),
                                         weights[1].data(), weights[2].data(), weights[3].data(), weights[4].data(),
                                         weights[5].data());
                for (std::size_t d = 0; d < 6; ++d) {
                    VecX difference = VecX::Zero(mesh.vertex_count);
                    for (std::size_t k = 0; k < count; ++k)
                        difference[indices[k]] += weights[d][k];
                    const auto own = basis.control_points(f);
                    for (std::size_t k = 0; k < own.size(); ++k)
                        difference[own[k]] -= (basis.stencil(f).*all_weights[d])(static_cast<Eigen::Index>(k), i);
                    EXPECT_LT(difference.cwiseAbs().maxCoeff(), d < 3 ? 1e-13 : 1e-11) << name << " " << d;
                }
            }
        }
    }
}

TEST(SurfaceBasis, SharesStencilsOfFacesAlike) {
    EXPECT_EQ(surface_basis(with_ghost_ring(fan(5)).mesh, 3).kind_count(), 1);
    const ControlMesh fine = catmull_clark_step(catmull_clark_step(with_ghost_ring(fan(5)).mesh).fine).fine;
    EXPECT_EQ(surface_basis(fine, 3).kind_count(), 2);
    // The four corners of a face are told apart.
    EXPECT_EQ(surface_basis(catmull_clark_step(with_ghost_ring(cubes({{0, 0, 0}})).mesh).fine, 3).kind_count(), 4);
}

TEST(LimitPoints, AreWhereSubdivisionLeads) {
    for (const auto& [name, quads, ordinary] : quad_samples()) {
        ControlMesh mesh = with_ghost_ring(quads).mesh;
        Positions p = random_positions(mesh.vertex_count);
        const Positions limits = p * limit_points(mesh).weights.transpose();
        for (int level = 0; level < 4; ++level) {
            const CatmullClarkStep step = catmull_clark_step(mesh);
            p = p * step.weights.transpose();
            mesh = step.fine;
            const Positions finer = p * limit_points(mesh).weights.transpose();
            for (int v = 0; v < quads.vertex_count(); ++v) // vertices keep their number
                EXPECT_LT((finer.col(v) - limits.col(v)).norm(), 1e-13) << name;
        }
    }
}

/// The points of a face cut into two by two are the limits of the next level's vertices.
TEST(LimitPoints, CutFacesEvenly) {
    for (const auto& [name, quads, ordinary] : quad_samples()) {
        const ControlMesh mesh = with_ghost_ring(quads).mesh;
        const CatmullClarkStep step = catmull_clark_step(mesh);
        const VertexWeights finer = limit_points(step.fine).weights * step.weights;
        const LimitPoints cut = limit_points(mesh, 2);
        ASSERT_EQ(cut.weights.rows(), step.fine.domain_vertex_count) << name;
        ASSERT_EQ(cut.quads.size(), 4 * quads.faces.size());
        const Positions p = random_positions(mesh.vertex_count);
        const Positions a = p * cut.weights.transpose(), b = p * finer.transpose();
        const std::array<std::size_t, 4> quarter = {0, 1, 3, 2}; // of the quads in rows
        for (std::size_t f = 0; f < quads.faces.size(); ++f)
            for (std::size_t c = 0; c < 4; ++c)
                for (std::size_t k = 0; k < 4; ++k)
                    EXPECT_LT((a.col(cut.quads[4 * f + quarter[c]][k]) - b.col(step.fine.faces[4 * f + c][k])).norm(),
                              1e-13)
                        << name;
        const LimitPoints thirds = limit_points(mesh, 3);
        EXPECT_LT(
            (thirds.weights * VecX::Ones(mesh.vertex_count) - VecX::Ones(thirds.weights.rows())).cwiseAbs().maxCoeff(),
            1e-13);
    }
}

/// The boundary's curve is the edge of the surface.
TEST(BoundaryBasis, LiesOnTheSurface) {
    for (const auto& [name, quads, ordinary] : quad_samples()) {
        const ControlMesh mesh = with_ghost_ring(quads).mesh;
        const BoundaryBasis basis = boundary_basis(mesh);
        const QuadConnectivity connectivity = mesh.connectivity();
        const Positions p = random_positions(mesh.vertex_count);
        ASSERT_EQ(basis.edge_count(), static_cast<int>(mesh.boundary.size()));
        for (int e = 0; e < basis.edge_count(); ++e) {
            const auto& [face, side] = mesh.boundary[static_cast<std::size_t>(e)];
            const std::array<Vec2, 4> corners = {Vec2(0, 0), Vec2(1, 0), Vec2(1, 1), Vec2(0, 1)};
            const Vec2 start = corners[static_cast<std::size_t>(side)];
            const Vec2 along = corners[static_cast<std::size_t>((side + 1) % 4)] - start;
            std::vector<Vec2> places;
            for (double t : gauss_on_line(4).points)
                places.emplace_back(start + t * along);
            const FaceRing ring = face_ring(mesh, connectivity, face);
            const FaceStencil s = face_stencil(ring.valence, places);
            const Positions value = evaluated(s.value, ring.points, p);
            const Positions tangent =
                along.x() * evaluated(s.du, ring.points, p) + along.y() * evaluated(s.dv, ring.points, p);
            EXPECT_LT((value - evaluated(basis.stencil(e).value, basis.control_points(e), p)).cwiseAbs().maxCoeff(),
                      1e-13)
                << name;
            EXPECT_LT((tangent - evaluated(basis.stencil(e).tangent, basis.control_points(e), p)).cwiseAbs().maxCoeff(),
                      1e-12)
                << name;
        }
    }
}

} // namespace
} // namespace plisse
