#include <plisse/subdivide/boundary_variables.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace plisse {

namespace {

/// Weights below this have cancelled: others are no smaller than 1e-4.
constexpr double cancelled = 1e-13;

std::size_t at(int index) {
    return static_cast<std::size_t>(index);
}

class BoundaryRows {
public:
    explicit BoundaryRows(const ControlMesh& mesh)
        : mesh_(mesh), connectivity_(mesh.connectivity()), to_(at(mesh.vertex_count)), from_(at(mesh.vertex_count)) {}

    ControlVariables run() {
        for (int v = 0; v < mesh_.vertex_count; ++v)
            to_[at(v)][v] = from_[at(v)][v] = 1;
        // In this order each rests on those before it.
        replace_at_reentrant_corners();
        const std::vector<Ghost> ghosts = find_ghosts(mesh_);
        for (Ghost::Kind kind : {Ghost::Kind::edge, Ghost::Kind::corner})
            for (int i = 0; i < mesh_.ghost_count(); ++i) {
                if (ghosts[at(i)].kind != kind)
                    continue;
                const int ghost = mesh_.domain_vertex_count + i;
                replace(ghost, kind == Ghost::Kind::edge ? curve_coefficient(ghost, ghosts[at(i)].vertex)
                                                         : limit(ghosts[at(i)].vertex));
            }
        return {assembled(to_), assembled(from_)};
    }

private:
    using Row = std::map<int, double>;

    /// The vertices around a re-entrant corner, named as in the header.
    struct ReentrantCorner {
        int p, a, g, b, b_i, l, f, d, a_i;
        std::array<int, 5> replaced() const { return {l, d, a, b, g}; }
        std::array<int, 4> others() const { return {p, f, a_i, b_i}; }
    };

    std::vector<ReentrantCorner> reentrant_corners() const {
        std::vector<ReentrantCorner> corners;
        for (std::size_t f = at(mesh_.domain_face_count); f < mesh_.faces.size(); ++f)
            for (int k = 0; k < 4; ++k) {
                const int side = 4 * static_cast<int>(f) + k;
                const int g = connectivity_.to(QuadConnectivity::next(side));
                const auto is_domain = [&](int h) { return !mesh_.is_ghost(connectivity_.from(h)); };
                if (!mesh_.is_ghost(g) || !is_domain(side) || !is_domain(QuadConnectivity::next(side)) ||
                    !is_domain(QuadConnectivity::previous(side)))
                    continue;
                std::array<int, 8> ring{};
                int spoke = side;
                for (std::size_t i = 0; i < 8; i += 2, spoke = connectivity_.rotated(spoke)) {
                    ring[i] = connectivity_.to(spoke);
                    ring[i + 1] = connectivity_.to(QuadConnectivity::next(spoke));
                }
                corners.push_back(
                    {connectivity_.from(side), ring[0], ring[1], ring[2], ring[3], ring[4], ring[5], ring[6], ring[7]});
            }
        return corners;
    }

    void replace_at_reentrant_corners() {
        const std::vector<ReentrantCorner> corners = reentrant_corners();
        std::map<int, int> replacing, using_otherwise; // corners, per vertex
        for (const ReentrantCorner& c : corners) {
            for (int v : c.replaced())
                ++replacing[v];
            for (int v : c.others())
                ++using_otherwise[v];
        }
        for (const ReentrantCorner& c : corners) {
            const auto replaced = c.replaced();
            const auto others = c.others();
            if (std::any_of(replaced.begin(), replaced.end(),
                            [&](int v) { return replacing[v] > 1 || using_otherwise.contains(v); }) ||
                std::any_of(others.begin(), others.end(), [&](int v) { return replacing.contains(v); }))
                continue;
            replace(c.l, {{c.b_i, 1}, {c.l, 4}, {c.f, 1}});
            replace(c.d, {{c.a_i, 1}, {c.d, 4}, {c.f, 1}});
            replace(c.a, {{c.l, 1}, {c.p, 4}, {c.a, 1}});
            replace(c.b, {{c.d, 1}, {c.p, 4}, {c.b, 1}});
            replace(c.g, {{c.g, 1}, {c.a, 2}, {c.b, 2}, {c.a_i, 0.5}, {c.b_i, 0.5}});
        }
    }

    /// Six times the coefficient of the boundary curve at a vertex.
    Row curve_coefficient(int ghost, int vertex) const {
        const std::vector<int> star = connectivity_.star(vertex);
        Row row = {{ghost, 1}, {vertex, 4}};
        for (std::size_t k = 0; k < 4; ++k)
            if (connectivity_.to(star[k]) == ghost)
                row[connectivity_.to(star[(k + 2) % 4])] = 1;
        return row;
    }

    /// 36 times the limit of an ordinary vertex.
    Row limit(int vertex) const {
        Row row = {{vertex, 16}};
        for (int h : connectivity_.star(vertex)) {
            row[connectivity_.to(h)] = 4;
            row[connectivity_.to(QuadConnectivity::next(h))] = 1;
        }
        return row;
    }

    /// Puts the mean of control points by these weights in the place of one of them.
    void replace(int replaced, const Row& weights) {
        double total = 0;
        for (const auto& [vertex, weight] : weights)
            total += weight;
        const double own = weights.at(replaced);
        Row& to = to_[at(replaced)];
        Row& from = from_[at(replaced)];
        to = {{replaced, total / own}};
        for (const auto& [vertex, weight] : weights) {
            from[vertex] = weight / total;
            if (vertex != replaced)
                for (const auto& [other, factor] : to_[at(vertex)])
                    to[other] -= weight / own * factor;
        }
    }

    VertexWeights assembled(const std::vector<Row>& rows) const {
        std::vector<Eigen::Triplet<double>> entries;
        for (std::size_t v = 0; v < rows.size(); ++v)
            for (const auto& [column, weight] : rows[v])
                if (weight != 0)
                    entries.emplace_back(static_cast<int>(v), column, weight);
        VertexWeights result(mesh_.vertex_count, mesh_.vertex_count);
        result.setFromTriplets(entries.begin(), entries.end());
        return result;
    }

    const ControlMesh& mesh_;
    QuadConnectivity connectivity_;
    std::vector<Row> to_, from_;
};

FaceStencil transformed(const FaceStencil& s, const Eigen::MatrixXd& m) {
    return {m * s.value, m * s.du, m * s.dv, m * s.duu, m * s.duv, m * s.dvv};
}
EdgeStencil transformed(const EdgeStencil& s, const Eigen::MatrixXd& m) {
    return {m * s.value, m * s.tangent};
}

double size(const FaceStencil& s, Eigen::Index row) {
    double largest = 0;
    for (const Eigen::MatrixXd* m : {&s.value, &s.du, &s.dv, &s.duu, &s.duv, &s.dvv})
        largest = std::max(largest, m->row(row).cwiseAbs().maxCoeff());
    return largest;
}
double size(const EdgeStencil& s, Eigen::Index row) {
    return std::max(s.value.row(row).cwiseAbs().maxCoeff(), s.tangent.row(row).cwiseAbs().maxCoeff());
}

/// Rewrites stencils in other variables; elements of one kind on which T acts alike stay of one kind.
template <typename Basis>
class Rewriter {
public:
    Rewriter(const Basis& basis, const ControlVariables& variables)
        : basis_(basis), rows_(variables.to_control_points), result_(basis.vertex_count(), basis.weights()) {}

    Basis run() {
        for (int element = 0; element < basis_.element_count(); ++element)
            add(element);
        return std::move(result_);
    }

private:
    /// Of one kind: its number afterwards, and which of the variables at hand have weight.
    struct Kind {
        int number;
        std::vector<std::size_t> kept;
    };

    void add(int element) {
        const auto points = basis_.control_points(element);
        std::vector<int> variables(points.begin(), points.end());
        std::vector<Eigen::Triplet<double>> entries;
        for (std::size_t p = 0; p < points.size(); ++p)
            for (typename Rows::InnerIterator entry(rows_, points[p]); entry; ++entry) {
                auto place = std::find(variables.begin(), variables.end(), static_cast<int>(entry.col()));
                if (place == variables.end())
                    place = variables.insert(place, static_cast<int>(entry.col()));
                entries.emplace_back(static_cast<int>(place - variables.begin()), static_cast<int>(p), entry.value());
            }
        // T's rows are ordered by vertex numbers, which faces alike do not share.
        std::sort(entries.begin(), entries.end(), [](const auto& a, const auto& b) {
            return std::pair(a.col(), a.row()) < std::pair(b.col(), b.row());
        });
        std::vector<double> key = {static_cast<double>(basis_.kind(element))};
        for (const auto& entry : entries)
            key.insert(key.end(), {static_cast<double>(entry.row()), static_cast<double>(entry.col()), entry.value()});
        auto place = kinds_.find(key);
        if (place == kinds_.end())
            place = kinds_.emplace(key, new_kind(element, variables.size(), points.size(), entries)).first;
        std::vector<int> kept;
        for (std::size_t k : place->second.kept)
            kept.push_back(variables[k]);
        result_.add_element(place->second.number, kept);
    }

    Kind new_kind(int element, std::size_t variable_count, std::size_t point_count,
                  const std::vector<Eigen::Triplet<double>>& entries) {
        Eigen::MatrixXd transposed =
            Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(variable_count), static_cast<Eigen::Index>(point_count));
        for (const auto& entry : entries)
            transposed(entry.row(), entry.col()) = entry.value();
        const auto all = transformed(basis_.stencil(element), transposed);
        Kind kind{};
        for (std::size_t k = 0; k < variable_count; ++k)
            if (size(all, static_cast<Eigen::Index>(k)) > cancelled)
                kind.kept.push_back(k);
        Eigen::MatrixXd kept_rows(static_cast<Eigen::Index>(kind.kept.size()), transposed.cols());
        for (std::size_t k = 0; k < kind.kept.size(); ++k)
            kept_rows.row(static_cast<Eigen::Index>(k)) = transposed.row(static_cast<Eigen::Index>(kind.kept[k]));
        kind.number = result_.add_kind(transformed(basis_.stencil(element), kept_rows));
        return kind;
    }

    using Rows = Eigen::SparseMatrix<double, Eigen::RowMajor>;
    const Basis& basis_;
    Rows rows_;
    Basis result_;
    std::map<std::vector<double>, Kind> kinds_;
};

VertexWeights without_cancelled(const VertexWeights& weights) {
    VertexWeights result = weights;
    result.prune([](Eigen::Index, Eigen::Index, double value) { return std::abs(value) > cancelled; });
    return result;
}

} // namespace

ControlVariables plain_variables(const ControlMesh& mesh) {
    VertexWeights identity(mesh.vertex_count, mesh.vertex_count);
    identity.setIdentity();
    return {identity, identity};
}

ControlVariables boundary_variables(const ControlMesh& mesh) {
    return BoundaryRows(mesh).run();
}

SurfaceBasis in_variables(const SurfaceBasis& basis, const ControlVariables& variables) {
    return Rewriter(basis, variables).run();
}

BoundaryBasis in_variables(const BoundaryBasis& basis, const ControlVariables& variables) {
    return Rewriter(basis, variables).run();
}

LimitPoints in_variables(const LimitPoints& points, const ControlVariables& variables) {
    return {without_cancelled(points.weights * variables.to_control_points), points.quads};
}

VertexWeights in_variables(const VertexWeights& weights, const ControlVariables& from, const ControlVariables& to) {
    return without_cancelled(to.from_control_points * weights * from.to_control_points);
}

} // namespace plisse
