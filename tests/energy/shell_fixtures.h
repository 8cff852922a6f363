#pragma once

#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include <plisse/base/random.h>
#include <plisse/energy/assembly.h>
#include <plisse/energy/hinge.h>
#include <plisse/energy/membrane.h>
#include <plisse/mesh/triangle_mesh.h>

namespace plisse::testing {

enum class Cells { one_diagonal, alternating, random };

/// The rectangle [0, width] x [0, height] at z = 0. jitter: how far inner vertices are moved, in cells.
inline TriangleMesh make_sheet(int nx, int ny, double width, double height, Cells cells = Cells::one_diagonal,
                               double jitter = 0) {
    Random random(7);
    TriangleMesh mesh;
    mesh.positions.resize(3, (nx + 1) * (ny + 1));
    const auto vertex = [&](int i, int j) { return j * (nx + 1) + i; };
    for (int j = 0; j <= ny; ++j)
        for (int i = 0; i <= nx; ++i) {
            const bool inner = i > 0 && i < nx && j > 0 && j < ny;
            const double dx = inner ? jitter * random.uniform(-1, 1) : 0;
            const double dy = inner ? jitter * random.uniform(-1, 1) : 0;
            mesh.positions.col(vertex(i, j)) << width * (i + dx) / nx, height * (j + dy) / ny, 0;
        }
    for (int j = 0; j < ny; ++j)
        for (int i = 0; i < nx; ++i) {
            const int a = vertex(i, j), b = vertex(i + 1, j), c = vertex(i + 1, j + 1), d = vertex(i, j + 1);
            const bool turned =
                (cells == Cells::alternating && (i + j) % 2 == 1) || (cells == Cells::random && random.below(2) == 1);
            if (turned) {
                mesh.faces.push_back({a, b, d});
                mesh.faces.push_back({b, c, d});
            } else {
                mesh.faces.push_back({a, b, c});
                mesh.faces.push_back({a, c, d});
            }
        }
    return mesh;
}

/// The unit sphere: an icosahedron refined `times` times, 10 * 4^times + 2 vertices, normals outward.
inline TriangleMesh make_icosphere(int times) {
    const double g = (1 + std::sqrt(5.0)) / 2;
    std::vector<Vec3> points{{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                             {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
    std::vector<Face> faces{{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                            {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                            {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
    for (int k = 0; k < times; ++k) {
        std::map<Edge, int> middles;
        const auto middle = [&](int a, int b) {
            const auto [at, is_new] =
                middles.insert({{std::min(a, b), std::max(a, b)}, static_cast<int>(points.size())});
            if (is_new)
                points.push_back((points[static_cast<std::size_t>(a)] + points[static_cast<std::size_t>(b)]) / 2);
            return at->second;
        };
        std::vector<Face> finer;
        for (const auto& [a, b, c] : faces) {
            const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
            finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
        }
        faces = finer;
    }
    TriangleMesh mesh;
    mesh.faces = faces;
    mesh.positions.resize(3, static_cast<int>(points.size()));
    for (std::size_t i = 0; i < points.size(); ++i)
        mesh.positions.col(static_cast<int>(i)) = points[i].normalized();
    return mesh;
}

inline MembraneEnergy make_membrane(const TriangleMesh& mesh, const Lame& lame, double thickness) {
    const auto count = mesh.faces.size();
    return {mesh.positions,
            mesh.faces,
            {std::vector<double>(count, lame.mu), std::vector<double>(count, lame.lambda),
             std::vector<double>(count, thickness)}};
}

inline HingeEnergy make_hinges(const TriangleMesh& mesh, double scaled_rigidity, bool flat = false,
                               HingeHessian kind = HingeHessian::gauss_newton) {
    const Connectivity connectivity(mesh.vertex_count(), mesh.faces);
    const Hinges hinges = interior_hinges(connectivity, mesh.faces);
    std::vector<double> rigidities = hinge_shares(hinges, connectivity, mesh.faces, mesh.positions);
    for (double& rigidity : rigidities)
        rigidity *= scaled_rigidity;
    return {mesh.positions,
            hinges.vertices,
            {rigidities, std::vector<std::uint8_t>(rigidities.size(), flat ? 1 : 0)},
            kind};
}

/// Leaves of two cells at one spine of two edges, at angles of 2 pi k/leaves and of different widths.
inline TriangleMesh make_book(int leaves) {
    TriangleMesh mesh;
    mesh.positions.resize(3, 3 + 3 * leaves);
    for (int j = 0; j < 3; ++j)
        mesh.positions.col(j) = Vec3(0, 0, j);
    for (int k = 0; k < leaves; ++k) {
        const double angle = 2 * std::numbers::pi * k / leaves, width = 0.7 + 0.2 * k;
        const int first = 3 + 3 * k;
        for (int j = 0; j < 3; ++j)
            mesh.positions.col(first + j) = Vec3(width * std::cos(angle), width * std::sin(angle), j + 0.1 * k);
        for (int j = 0; j < 2; ++j) {
            mesh.faces.push_back({j, first + j, first + j + 1});
            mesh.faces.push_back({j, first + j + 1, j + 1});
        }
    }
    return mesh;
}

/// The mesh with the faces of the leaves turned whose bit is set.
inline TriangleMesh turned_leaves(TriangleMesh book, int bits) {
    for (std::size_t f = 0; f < book.faces.size(); ++f)
        if ((bits >> (f / 4) & 1) != 0)
            std::swap(book.faces[f][1], book.faces[f][2]);
    return book;
}

inline Positions perturbed(const Positions& x, double size, std::uint64_t seed = 3) {
    Random random(seed);
    return x.unaryExpr([&](double value) { return value + size * random.uniform(-1, 1); });
}

inline Mat3 random_rotation(Random& random) {
    const auto signed_unit = [&] { return random.uniform(-1, 1); };
    return Eigen::Quaterniond(signed_unit(), signed_unit(), signed_unit(), signed_unit()).normalized().matrix();
}

/// Eigenvalues below zero become zero, by the general solver.
inline Eigen::MatrixXd general_positive_part(const Eigen::MatrixXd& symmetric) {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(symmetric);
    return solver.eigenvectors() * solver.eigenvalues().cwiseMax(0.0).asDiagonal() * solver.eigenvectors().transpose();
}

inline double lowest_eigenvalue(const Eigen::MatrixXd& symmetric) {
    return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(symmetric, Eigen::EigenvaluesOnly).eigenvalues()[0];
}

/// Central difference of f (of a vector, to anything with + - and /) at x along each unknown, one column each.
template <typename Function>
Eigen::MatrixXd central_differences(const Function& f, const VecX& x, double step) {
    Eigen::MatrixXd columns;
    for (int k = 0; k < x.size(); ++k) {
        VecX above = x, below = x;
        above[k] += step;
        below[k] -= step;
        const VecX difference = (f(above) - f(below)) / (above[k] - below[k]);
        if (k == 0)
            columns.resize(difference.size(), x.size());
        columns.col(k) = difference;
    }
    return columns;
}

inline double total_value(const ElementEnergy& energy, const VecX& x) {
    return ElementAssembly(energy, static_cast<int>(x.size() / 3)).value(as_positions(x));
}

inline VecX total_gradient(const ElementEnergy& energy, const VecX& x) {
    Positions gradient = Positions::Zero(3, x.size() / 3);
    ElementAssembly(energy, static_cast<int>(x.size() / 3)).add_gradient(as_positions(x), gradient);
    return as_vector(gradient);
}

inline Eigen::MatrixXd total_hessian(const ElementEnergy& energy, const VecX& x, bool project) {
    Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(x.size(), x.size());
    std::array<double, 9 * ElementEnergy::most_vertices * ElementEnergy::most_vertices> buffer;
    for (int e = 0; e < energy.element_count(); ++e) {
        energy.hessian(e, as_positions(x), project, buffer.data());
        const auto v = energy.vertices(e);
        const int k = static_cast<int>(v.size());
        const Eigen::Map<const Eigen::MatrixXd> local(buffer.data(), 3 * k, 3 * k);
        for (int j = 0; j < k; ++j)
            for (int i = 0; i < k; ++i)
                dense.block<3, 3>(3 * v[static_cast<std::size_t>(i)], 3 * v[static_cast<std::size_t>(j)]) +=
                    local.block<3, 3>(3 * i, 3 * j);
    }
    return dense;
}

/// Largest error of the gradient and of the unprojected Hessian against central differences, relative to the largest
/// entry of the Hessian (times `length` for the gradient, so that a zero gradient can be tested).
struct DerivativeErrors {
    double gradient, hessian;
};
inline DerivativeErrors derivative_errors(const ElementEnergy& energy, const Positions& at, double length) {
    const VecX x = as_vector(at);
    const Eigen::MatrixXd hessian = total_hessian(energy, x, false);
    const double scale = hessian.cwiseAbs().maxCoeff();
    const auto value = [&](const VecX& y) { return VecX::Constant(1, total_value(energy, y)).eval(); };
    const auto gradient = [&](const VecX& y) { return total_gradient(energy, y); };
    const Eigen::MatrixXd by_value = central_differences(value, x, 1e-5 * length);
    const Eigen::MatrixXd by_gradient = central_differences(gradient, x, 1e-5 * length);
    const double gradient_scale = std::max(gradient(x).cwiseAbs().maxCoeff(), 1e-2 * scale * length);
    return {(by_value.transpose() - gradient(x)).cwiseAbs().maxCoeff() / gradient_scale,
            (by_gradient - hessian).cwiseAbs().maxCoeff() / scale};
}

/// Minimises membrane + dead forces over the unknowns that are not fixed by dense Newton; true when the residual force
/// is below `tolerance`. The exact Hessian takes full steps: any equilibrium will do.
inline bool dense_newton(const ElementEnergy& energy, const Positions& forces, const std::vector<bool>& fixed,
                         Positions& x, double tolerance, int most_iterations = 50) {
    std::vector<int> free;
    for (std::size_t k = 0; k < fixed.size(); ++k)
        if (!fixed[k])
            free.push_back(static_cast<int>(k));
    VecX unknowns = as_vector(x);
    for (int iteration = 0; iteration <= most_iterations; ++iteration) {
        const VecX residual = (total_gradient(energy, unknowns) - as_vector(forces))(free);
        if (residual.cwiseAbs().maxCoeff() <= tolerance) {
            x = as_positions(unknowns);
            return true;
        }
        const Eigen::MatrixXd hessian = total_hessian(energy, unknowns, false)(free, free);
        const VecX step = hessian.partialPivLu().solve(-residual);
        for (std::size_t k = 0; k < free.size(); ++k)
            unknowns[free[k]] += step[static_cast<int>(k)];
    }
    return false;
}

} // namespace plisse::testing
