#include <plisse/energy/koiter.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>
#include <Eigen/SparseCholesky>

#include <plisse/base/parallel.h>
#include <plisse/energy/dihedral_terms.h>

namespace plisse {

namespace {

constexpr int grain = 256;

std::size_t at(int index) {
    return static_cast<std::size_t>(index);
}

/// d2 W / d alpha2 = c D/A [(1 - nu) (e_j.e_k)^2/(l_j l_k) + nu l_j l_k], since edges and their normals in the face
/// make the same angles. Edge k runs from corner k to the next.
Mat3 turn_stiffness(const Positions& rest, const Face& face, double scaled_rigidity, double poisson_ratio) {
    Mat3 edges;
    for (int k = 0; k < 3; ++k)
        edges.col(k) = rest.col(face[at((k + 1) % 3)]) - rest.col(face[at(k)]);
    const double area = edges.col(0).cross(edges.col(1)).norm() / 2;
    assert(area > 0);
    const Vec3 lengths = edges.colwise().norm();
    const Mat3 products = lengths * lengths.transpose();
    const Mat3 dots = edges.transpose() * edges;
    return scaled_rigidity / area *
           ((1 - poisson_ratio) * dots.cwiseAbs2().cwiseQuotient(products) + poisson_ratio * products);
}

} // namespace

KoiterFaces::KoiterFaces(const Positions& rest, std::span<const Face> faces, const KoiterMaterials& materials)
    : vertex_count_(static_cast<int>(rest.cols())) {
    assert(materials.scaled_rigidity.size() == faces.size() && materials.poisson_ratio.size() == faces.size() &&
           materials.flat.size() == faces.size());
    const Connectivity connectivity(vertex_count_, faces);
    edge_count_ = connectivity.edge_count();
    const std::vector<int> hinge_of_edge = find_hinges(rest, connectivity, faces, materials.flat);
    for (std::size_t f = 0; f < faces.size(); ++f) {
        ElementFace element{};
        element.edges = {connectivity.face_edges()[f], Vec3::Ones(), Vec3::Zero(),
                         turn_stiffness(rest, faces[f], materials.scaled_rigidity[f], materials.poisson_ratio[f])};
        for (int k = 0; k < 3; ++k) {
            const int edge = element.edges.edges[at(k)];
            const auto sides = connectivity.edge_faces(edge);
            const auto place = std::find(sides.begin(), sides.end(), static_cast<int>(f)) - sides.begin();
            const bool at_joint = sides.size() > 2;
            if (sides.size() == 1 || (at_joint && place == 0))
                continue;
            const int hinge = hinge_of_edge[at(edge)] + std::max(0, static_cast<int>(place) - 1);
            element.sides[at(k)].hinge = hinge;
            if (place > 0)
                element.edges.sign[k] = -1;
            if (at_joint)
                element.edges.share[k] = 1;
            const auto& corners = hinges_[at(hinge)];
            if (at_joint && faces[f][at(k)] == corners[0]) { // it runs along the edge as the first face does
                element.edges.sign[k] *= -1;
                element.edges.share[k] *= -1;
            }
        }
        number_vertices(element, faces[f]);
        faces_.push_back(element);
    }
    share_angles(connectivity);
}

/// Those of the first face of each edge with its others. Returns the number of an edge's first one.
std::vector<int> KoiterFaces::find_hinges(const Positions& rest, const Connectivity& connectivity,
                                          std::span<const Face> faces, std::span<const std::uint8_t> flat) {
    const Hinges hinges = interior_hinges(connectivity, faces);
    std::vector<int> of_edge(at(edge_count_), -1);
    for (std::size_t h = 0; h < hinges.edges.size(); ++h) {
        const int edge = hinges.edges[h], first = hinges.faces[h][0];
        if (first != connectivity.edge_faces(edge)[0])
            continue;
        if (of_edge[at(edge)] < 0)
            of_edge[at(edge)] = static_cast<int>(hinges_.size());
        const bool is_flat = flat[at(first)] && !connectivity.is_curve_edge(edge);
        hinges_.push_back(hinges.vertices[h]);
        rest_angles_.push_back(is_flat ? 0.0 : dihedral_angle_at(hinges_.back(), rest));
    }
    return of_edge;
}

/// The face's own vertices first.
void KoiterFaces::number_vertices(ElementFace& element, const Face& face) const {
    const auto number_of = [&](int vertex) {
        const auto end = element.vertices.begin() + element.vertex_count;
        const auto found = std::find(element.vertices.begin(), end, vertex);
        if (found == end)
            element.vertices[at(element.vertex_count++)] = vertex;
        return static_cast<int>(found - element.vertices.begin());
    };
    for (int v : face)
        number_of(v);
    for (Side& side : element.sides)
        if (side.hinge >= 0) {
            const auto& corners = hinges_[at(side.hinge)];
            std::transform(corners.begin(), corners.end(), side.corners.begin(), number_of);
        }
}

void KoiterFaces::share_angles(const Connectivity& connectivity) {
    std::vector<double> of_edge(at(edge_count_), 0.0); // stiffness of both faces
    for (const ElementFace& element : faces_)
        for (int k = 0; k < 3; ++k)
            of_edge[at(element.edges.edges[at(k)])] += element.edges.stiffness(k, k);
    for (ElementFace& element : faces_)
        for (int k = 0; k < 3; ++k)
            if (const int edge = element.edges.edges[at(k)]; !connectivity.is_curve_edge(edge))
                element.edges.share[k] = 1 - element.edges.stiffness(k, k) / of_edge[at(edge)];
}

std::span<const int> KoiterFaces::vertices(int face) const {
    const ElementFace& element = faces_[at(face)];
    return std::span(element.vertices).first(at(element.vertex_count));
}

Vec3 KoiterFaces::angles(int face, const Positions& x) const {
    Vec3 result = Vec3::Zero();
    for (int k = 0; k < 3; ++k)
        if (const int h = faces_[at(face)].sides[at(k)].hinge; h >= 0)
            result[k] = edges_of(face).share[k] * (dihedral_angle_at(hinges_[at(h)], x) - rest_angles_[at(h)]);
    return result;
}

Vec3 KoiterFaces::turns(int face, const Positions& x) const {
    const FaceEdges& edges = edges_of(face);
    Vec3 result = angles(face, x);
    for (int k = 0; k < 3; ++k) {
        const int edge = edges.edges[at(k)];
        result[k] += edges.sign[k] * x(edge % 3, vertex_count_ + edge / 3);
    }
    return result;
}

double KoiterFaces::value(int face, const Positions& x) const {
    const Vec3 alpha = turns(face, x);
    const double energy = alpha.dot(edges_of(face).stiffness * alpha) / 2;
    return std::isnan(energy) ? std::numeric_limits<double>::infinity() : energy;
}

void KoiterFaces::gradient(int face, const Positions& x, double* gradient) const {
    const ElementFace& element = faces_[at(face)];
    const Vec3 moments = element.edges.stiffness * turns(face, x);
    Eigen::Map<VecX> result(gradient, 3 * element.vertex_count);
    result.setZero();
    for (int k = 0; k < 3; ++k) {
        const Side& side = element.sides[at(k)];
        if (side.hinge < 0)
            continue;
        const Vec12 slope = dihedral_gradient(dihedral_at(hinges_[at(side.hinge)], x));
        const double share = element.edges.share[k];
        for (int c = 0; c < 4; ++c)
            result.segment<3>(3 * side.corners[at(c)]) += share * moments[k] * slope.segment<3>(3 * c);
    }
}

void KoiterFaces::hessian(int face, const Positions& x, bool project, double* hessian) const {
    const ElementFace& element = faces_[at(face)];
    const Vec3 moments = element.edges.stiffness * turns(face, x);
    const int size = 3 * element.vertex_count;
    Eigen::Map<Eigen::MatrixXd> result(hessian, size, size);
    result.setZero();
    using Slopes = Eigen::Matrix<double, 3 * most_vertices, 3>;
    Slopes slopes = Slopes::Zero();
    for (int k = 0; k < 3; ++k) {
        const Side& side = element.sides[at(k)];
        if (side.hinge < 0)
            continue;
        const Dihedral state = dihedral_at(hinges_[at(side.hinge)], x);
        const Vec12 slope = dihedral_gradient(state);
        const double share = element.edges.share[k], moment = share * moments[k];
        const Mat12 curved = project ? projected_hessian(state, 0, moment) : Mat12(moment * dihedral_hessian(state));
        for (int c = 0; c < 4; ++c) {
            slopes.block<3, 1>(3 * side.corners[at(c)], k) += share * slope.segment<3>(3 * c);
            for (int d = 0; d < 4; ++d)
                result.block<3, 3>(3 * side.corners[at(c)], 3 * side.corners[at(d)]) +=
                    curved.block<3, 3>(3 * c, 3 * d);
        }
    }
    const Slopes weighted = slopes * element.edges.stiffness;
    result.noalias() += weighted.topRows(size) * slopes.topRows(size).transpose();
}

/// The matrix of the turns, d2 W / d phi2.
struct KoiterBending::TurnSolver {
    explicit TurnSolver(const KoiterFaces& faces) {
        std::vector<Eigen::Triplet<double>> entries;
        for (int f = 0; f < faces.element_count(); ++f) {
            const KoiterFaces::FaceEdges& face = faces.edges_of(f);
            for (int j = 0; j < 3; ++j)
                for (int i = 0; i < 3; ++i)
                    if (face.edges[at(i)] >= face.edges[at(j)])
                        entries.emplace_back(face.edges[at(i)], face.edges[at(j)],
                                             face.sign[i] * face.stiffness(i, j) * face.sign[j]);
        }
        Eigen::SparseMatrix<double> matrix(faces.edge_count(), faces.edge_count());
        matrix.setFromTriplets(entries.begin(), entries.end());
        factor.compute(matrix);
        assert(factor.info() == Eigen::Success);
    }
    Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> factor;
};

KoiterBending::KoiterBending(const Positions& rest, std::span<const Face> faces, const KoiterMaterials& materials)
    : faces_(rest, faces, materials), assembly_(faces_, faces_.vertex_count()),
      solver_(std::make_unique<TurnSolver>(faces_)) {}

KoiterBending::~KoiterBending() = default;

const Positions& KoiterBending::with_turns(const Positions& x) const {
    if (with_turns_.cols() != 0 && with_turns_.leftCols(x.cols()) == x)
        return with_turns_;
    with_turns_ = Positions::Zero(3, x.cols() + faces_.turn_columns());
    with_turns_.leftCols(x.cols()) = x;
    std::vector<Vec3> moments(at(faces_.element_count()));
    parallel_for(faces_.element_count(), grain, [&](int f) {
        const KoiterFaces::FaceEdges& face = faces_.edges_of(f);
        moments[at(f)] = face.sign.cwiseProduct(face.stiffness * faces_.angles(f, x));
    });
    VecX sums = VecX::Zero(faces_.edge_count());
    for (int f = 0; f < faces_.element_count(); ++f)
        for (int k = 0; k < 3; ++k)
            sums[faces_.edges_of(f).edges[at(k)]] -= moments[at(f)][k];
    Eigen::Map<VecX>(with_turns_.data() + 3 * x.cols(), faces_.edge_count()) = solver_->factor.solve(sums);
    return with_turns_;
}

double KoiterBending::value(const Positions& x) const {
    return assembly_.value(with_turns(x));
}

void KoiterBending::add_gradient(const Positions& x, Positions& gradient) const {
    assembly_.add_gradient(with_turns(x), gradient);
}

void KoiterBending::add_hessian(const Positions& x, NewtonSystem& system, bool project) const {
    assembly_.add_hessian(with_turns(x), system, project);
}

} // namespace plisse
