#include <plisse/subdivide/surface_basis.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>

#include <plisse/subdivide/face_ring.h>

namespace plisse {

namespace {

/// Rows that stand for the same control point added up.
struct Merge {
    std::vector<int> slot; ///< per row: its row afterwards
    std::vector<int> points;

    explicit Merge(const std::vector<int>& all) {
        for (int v : all) {
            const auto place = std::find(points.begin(), points.end(), v);
            slot.push_back(static_cast<int>(place - points.begin()));
            if (place == points.end())
                points.push_back(v);
        }
    }

    Eigen::MatrixXd operator()(const Eigen::MatrixXd& m) const {
        Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(points.size()), m.cols());
        for (std::size_t i = 0; i < slot.size(); ++i)
            sum.row(slot[i]) += m.row(static_cast<Eigen::Index>(i));
        return sum;
    }
};

/// The 12 vertices along the side from corner 0 to corner 1 of a ring whose first two corners are ordinary, row by row
/// from across the boundary: the places of ordinary_places with v = -1, 0, 1.
std::vector<int> points_along_first_side(const FaceRing& ring) {
    const std::vector<int>& p = ring.points;
    const std::size_t last = p.size() - 1; // the last edge neighbour of corner 3
    const std::size_t of_corner_2 = 10;    // the first edge neighbour of corner 2
    return {p[5], p[6], p[7], p[8], p[4], p[0], p[1], p[9], p[last], p[3], p[2], p[of_corner_2]};
}

/// The ring of a face as if its corner `first` were corner 0.
FaceRing rotated(const FaceRing& ring, std::size_t first) {
    FaceRing result;
    std::array<std::size_t, 5> starts{4};
    for (std::size_t c = 0; c < 4; ++c)
        starts[c + 1] = starts[c] + static_cast<std::size_t>(2 * ring.valence[c] - 5);
    for (std::size_t c = 0; c < 4; ++c) {
        result.valence[c] = ring.valence[(c + first) % 4];
        result.points.push_back(ring.points[(c + first) % 4]);
    }
    for (std::size_t k = 0; k < 4; ++k) {
        const std::size_t c = (k + first) % 4;
        for (std::size_t i = starts[c]; i < starts[c + 1]; ++i)
            result.points.push_back(ring.points[i]);
    }
    return result;
}

EdgeStencil edge_stencil(const std::vector<double>& points) {
    EdgeStencil stencil;
    const auto count = static_cast<Eigen::Index>(points.size());
    stencil.value.resize(12, count);
    stencil.tangent.resize(12, count);
    const Eigen::Vector4d across = bspline(0);
    for (Eigen::Index p = 0; p < count; ++p)
        for (Eigen::Index row = 0; row < 3; ++row) {
            const double t = points[static_cast<std::size_t>(p)];
            stencil.value.block<4, 1>(4 * row, p) = across[row] * bspline(t);
            stencil.tangent.block<4, 1>(4 * row, p) = across[row] * bspline_derivative(t);
        }
    return stencil;
}

} // namespace

Quadrature<double> gauss_on_line(int count) {
    assert(count >= 2 && count <= 4);
    std::vector<double> roots, weights; // on [-1, 1], the lower half
    if (count == 2) {
        roots = {-std::sqrt(1.0 / 3)};
        weights = {1};
    } else if (count == 3) {
        roots = {-std::sqrt(0.6), 0};
        weights = {5.0 / 9, 8.0 / 9};
    } else {
        const double inner = std::sqrt(3.0 / 7 - 2.0 / 7 * std::sqrt(1.2));
        const double outer = std::sqrt(3.0 / 7 + 2.0 / 7 * std::sqrt(1.2));
        roots = {-outer, -inner};
        weights = {(18 - std::sqrt(30.0)) / 36, (18 + std::sqrt(30.0)) / 36};
    }
    Quadrature<double> result;
    for (int i = 0; i < count; ++i) {
        const bool lower = 2 * i < count;
        const auto k = static_cast<std::size_t>(lower ? i : count - 1 - i);
        result.points.push_back(0.5 + 0.5 * (lower ? roots[k] : -roots[k]));
        result.weights.push_back(0.5 * weights[k]);
    }
    return result;
}

Quadrature<Vec2> gauss_on_square(int count_a_side) {
    const Quadrature<double> line = gauss_on_line(count_a_side);
    Quadrature<Vec2> result;
    for (std::size_t j = 0; j < line.points.size(); ++j)
        for (std::size_t i = 0; i < line.points.size(); ++i) {
            result.points.emplace_back(line.points[i], line.points[j]);
            result.weights.push_back(line.weights[i] * line.weights[j]);
        }
    return result;
}

SurfaceBasis surface_basis(const ControlMesh& mesh, const Quadrature<Vec2>& quadrature) {
    const QuadConnectivity connectivity = mesh.connectivity();
    SurfaceBasis basis(mesh.vertex_count, quadrature.weights);
    std::map<std::array<int, 4>, FaceStencil> stencils;
    std::map<std::pair<std::array<int, 4>, std::vector<int>>, int> kinds; // by valences and points that coincide
    for (int f = 0; f < mesh.domain_face_count; ++f) {
        const FaceRing ring = face_ring(mesh, connectivity, f);
        const Merge merge(ring.points);
        const auto [kind, is_new] = kinds.try_emplace({ring.valence, merge.slot}, basis.kind_count());
        if (is_new) {
            if (!stencils.contains(ring.valence))
                stencils[ring.valence] = face_stencil(ring.valence, quadrature.points);
            const FaceStencil& s = stencils[ring.valence];
            basis.add_kind({merge(s.value), merge(s.du), merge(s.dv), merge(s.duu), merge(s.duv), merge(s.dvv)});
        }
        basis.add_element(kind->second, merge.points);
    }
    return basis;
}

SurfaceBasis surface_basis(const ControlMesh& mesh, int gauss_points_a_side) {
    return surface_basis(mesh, gauss_on_square(gauss_points_a_side));
}

BoundaryBasis boundary_basis(const ControlMesh& mesh) {
    const QuadConnectivity connectivity = mesh.connectivity();
    const Quadrature<double> quadrature = gauss_on_line(4);
    const EdgeStencil stencil = edge_stencil(quadrature.points);
    BoundaryBasis basis(mesh.vertex_count, quadrature.weights);
    std::map<std::vector<int>, int> kinds; // by points that coincide
    for (const auto& [face, side] : mesh.boundary) {
        const FaceRing ring = rotated(face_ring(mesh, connectivity, face), static_cast<std::size_t>(side));
        const Merge merge(points_along_first_side(ring));
        const auto [kind, is_new] = kinds.try_emplace(merge.slot, basis.kind_count());
        if (is_new)
            basis.add_kind({merge(stencil.value), merge(stencil.tangent)});
        basis.add_element(kind->second, merge.points);
    }
    return basis;
}

} // namespace plisse
