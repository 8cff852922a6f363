#include <plisse/subdivide/projection.h>

#include <cassert>
#include <map>

#include <plisse/base/error.h>

namespace plisse {

namespace {

std::size_t at(int index) {
    return static_cast<std::size_t>(index);
}

class ReverseSubdivision {
public:
    ReverseSubdivision(const ControlMesh& coarse, const CatmullClarkStep& step)
        : coarse_(coarse), step_(step), connectivity_(coarse.connectivity()), rows_(at(coarse.vertex_count)) {}

    VertexWeights run() {
        std::vector<int> left; // of valence 3
        for (int v = 0; v < coarse_.domain_vertex_count; ++v)
            if (connectivity_.star(v).size() == 3)
                left.push_back(v);
            else
                add_by_star(v);
        while (!left.empty())
            left = add_by_edges(left);
        add_ghosts();
        return assembled();
    }

private:
    using Row = std::map<int, double>;

    static void add(Row& row, const Row& other, double factor) {
        for (const auto& [column, weight] : other)
            row[column] += factor * weight;
    }

    int vertex_point(int v) const { return step_.vertex_child[at(v)]; }
    int edge_point(int side) const { return step_.edge_child[at(connectivity_.edge(side))]; }
    int face_point(int side) const { return step_.face_child[at(side / 4)]; }

    void add_by_star(int v) {
        const std::vector<int> star = connectivity_.star(v);
        const auto t = static_cast<double>(star.size());
        Row& row = rows_[at(v)];
        row[vertex_point(v)] = t / (t - 3);
        for (int h : star) {
            row[edge_point(h)] = -4 / (t * (t - 3));
            row[face_point(h)] = 1 / (t * (t - 3));
        }
    }

    /// The end of a side from its start.
    void add_far_end(Row& row, int side, double factor) const {
        row[edge_point(side)] += 4 * factor;
        row[face_point(side)] -= factor;
        row[face_point(connectivity_.twin(side))] -= factor;
        add(row, rows_[at(connectivity_.from(side))], -factor);
    }

    /// Vertices of valence 3 beside known ones; returns the others.
    std::vector<int> add_by_edges(const std::vector<int>& wanted) {
        std::vector<int> left;
        std::map<int, Row> found;
        for (int v : wanted) {
            std::vector<int> sides; // from known vertices to v
            for (int h : connectivity_.star(v))
                if (const int twin = connectivity_.twin(h); is_known_domain(connectivity_.from(twin)))
                    sides.push_back(twin);
            for (int side : sides)
                add_far_end(found[v], side, 1.0 / static_cast<double>(sides.size()));
            if (sides.empty())
                left.push_back(v);
        }
        if (found.empty())
            throw InputError("", "all vertices of a component have three faces",
                             "subdivide the mesh once, or let other numbers of faces meet");
        for (auto& [v, row] : found)
            rows_[at(v)] = std::move(row);
        return left;
    }

    bool is_known_domain(int v) const { return !coarse_.is_ghost(v) && !rows_[at(v)].empty(); }

    void add_ghosts() {
        const std::vector<Ghost> ghosts = find_ghosts(coarse_);
        for (int pass : {0, 1}) // corners need those across edges
            for (int i = 0; i < coarse_.ghost_count(); ++i) {
                const int g = coarse_.domain_vertex_count + i;
                const auto& [kind, vertex] = ghosts[at(i)];
                if ((kind == Ghost::Kind::corner) != (pass == 1))
                    continue;
                for (int h : connectivity_.star(vertex)) {
                    if (kind == Ghost::Kind::edge && connectivity_.to(h) == g)
                        add_far_end(rows_[at(g)], h, 1);
                    if (kind != Ghost::Kind::edge && connectivity_.to(QuadConnectivity::next(h)) == g)
                        add_opposite(rows_[at(g)], h);
                }
            }
    }

    /// The corner opposite to the start of a side in its face.
    void add_opposite(Row& row, int side) const {
        row[face_point(side)] += 4;
        const int opposite = QuadConnectivity::next(QuadConnectivity::next(side));
        for (int k = 0; k < 4; ++k)
            if (const int corner = (side & ~3) + k; corner != opposite)
                add(row, rows_[at(connectivity_.from(corner))], -1);
    }

    VertexWeights assembled() const {
        std::vector<Eigen::Triplet<double>> entries;
        for (std::size_t v = 0; v < rows_.size(); ++v)
            for (const auto& [column, weight] : rows_[v])
                entries.emplace_back(static_cast<int>(v), column, weight);
        VertexWeights result(coarse_.vertex_count, step_.fine.vertex_count);
        result.setFromTriplets(entries.begin(), entries.end());
        return result;
    }

    const ControlMesh& coarse_;
    const CatmullClarkStep& step_;
    QuadConnectivity connectivity_;
    std::vector<Row> rows_;
};

VertexWeights identity(Eigen::Index size) {
    VertexWeights result(size, size);
    result.setIdentity();
    return result;
}

} // namespace

VertexWeights reverse_subdivision(const ControlMesh& coarse, const CatmullClarkStep& step) {
    return ReverseSubdivision(coarse, step).run();
}

LeastSquaresProjection::LeastSquaresProjection(VertexWeights subdivision)
    : LeastSquaresProjection(subdivision, identity(subdivision.rows()), identity(subdivision.cols())) {}

LeastSquaresProjection::LeastSquaresProjection(VertexWeights subdivision, VertexWeights to_fine_points,
                                               VertexWeights from_coarse_points)
    : subdivision_(std::move(subdivision)), to_fine_points_(std::move(to_fine_points)),
      from_coarse_points_(std::move(from_coarse_points)) {
    const VertexWeights normal = subdivision_.transpose() * subdivision_;
    factor_ = std::make_shared<const Eigen::SimplicialLLT<VertexWeights>>(normal);
    assert(factor_->info() == Eigen::Success);
}

Positions LeastSquaresProjection::apply(const ConstPositions& fine) const {
    const Eigen::MatrixXd points = to_fine_points_ * fine.transpose();
    const Eigen::MatrixXd nearest = factor_->solve(subdivision_.transpose() * points);
    return (from_coarse_points_ * nearest).transpose();
}

} // namespace plisse
