#pragma once

#include <memory>
#include <span>
#include <vector>

#include <plisse/subdivide/catmull_clark_step.h>
#include <plisse/subdivide/limit_stencils.h>

namespace plisse {

/// Points of an element and their quadrature weights, which sum to 1.
template <typename Point>
struct Quadrature {
    std::vector<Point> points;
    std::vector<double> weights;
};

/// Gauss-Legendre points of [0, 1] and of [0, 1]^2; the square's number j count + i is number i in u and j in v. count:
/// 2 to 4.
Quadrature<double> gauss_on_line(int count);
Quadrature<Vec2> gauss_on_square(int count_a_side);

/// Basis functions of a limit surface at the same sample points of each of its elements (faces or boundary edges).
/// Elements alike share a stencil.
template <typename Stencil>
class SharedStencils {
public:
    SharedStencils() = default;
    SharedStencils(int vertex_count, std::vector<double> weights)
        : vertex_count_(vertex_count), weights_(std::move(weights)) {}

    int vertex_count() const { return vertex_count_; } ///< of control points of the mesh
    int element_count() const { return static_cast<int>(kinds_.size()); }
    int point_count() const { return static_cast<int>(weights_.size()); } ///< sample points of every element
    double weight(int point) const { return weights_[static_cast<std::size_t>(point)]; }
    const std::vector<double>& weights() const { return weights_; }

    /// Distinct vertices, one for every row of the stencil.
    std::span<const int> control_points(int element) const {
        const auto first = static_cast<std::size_t>(starts_[static_cast<std::size_t>(element)]);
        const auto end = static_cast<std::size_t>(starts_[static_cast<std::size_t>(element) + 1]);
        return std::span(control_points_).subspan(first, end - first);
    }
    const Stencil& stencil(int element) const { return stencils_[static_cast<std::size_t>(kind(element))]; }

    /// Elements of one kind have the same stencil.
    int kind(int element) const { return kinds_[static_cast<std::size_t>(element)]; }
    int kind_count() const { return static_cast<int>(stencils_.size()); }

    int add_kind(Stencil stencil) {
        stencils_.push_back(std::move(stencil));
        return kind_count() - 1;
    }
    void add_element(int kind, std::span<const int> control_points) {
        kinds_.push_back(kind);
        control_points_.insert(control_points_.end(), control_points.begin(), control_points.end());
        starts_.push_back(static_cast<int>(control_points_.size()));
    }

private:
    int vertex_count_ = 0;
    std::vector<double> weights_;
    std::vector<Stencil> stencils_;
    std::vector<int> kinds_;
    std::vector<int> control_points_, starts_{0};
};

/// Of the domain faces of a control mesh, in their order.
class SurfaceBasis : public SharedStencils<FaceStencil> {
public:
    using SharedStencils::SharedStencils;
    int face_count() const { return element_count(); }
};

/// Of its boundary sides, in their order.
class BoundaryBasis : public SharedStencils<EdgeStencil> {
public:
    using SharedStencils::SharedStencils;
    int edge_count() const { return element_count(); }
};

/// Points are none of the corners of [0, 1]^2.
SurfaceBasis surface_basis(const ControlMesh& mesh, const Quadrature<Vec2>& quadrature);
SurfaceBasis surface_basis(const ControlMesh& mesh, int gauss_points_a_side);

/// The boundary curve at four Gauss points of every boundary side. A boundary is a row of ordinary vertices, so it is a
/// cubic B-spline whose coefficients are (p_-1 + 4 p_0 + p_1) / 6 across it.
BoundaryBasis boundary_basis(const ControlMesh& mesh);

} // namespace plisse
