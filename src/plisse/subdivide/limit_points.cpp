#include <plisse/subdivide/limit_points.h>

#include <algorithm>
#include <cassert>

#include <plisse/subdivide/surface_basis.h>

namespace plisse {

namespace {

class PointMaker {
public:
    PointMaker(const ControlMesh& mesh, int parts) : mesh_(mesh), connectivity_(mesh.connectivity()), parts_(parts) {}

    LimitPoints run() {
        for (int v = 0; v < mesh_.domain_vertex_count; ++v)
            add_vertex(v);
        count_domain_edges();
        if (parts_ > 1)
            add_points_between();
        for (int f = 0; f < mesh_.domain_face_count; ++f)
            add_quads(f);
        LimitPoints result;
        const int inner = parts_ - 1;
        result.weights.resize(mesh_.domain_vertex_count + inner * (domain_edges_ + inner * mesh_.domain_face_count),
                              mesh_.vertex_count);
        result.weights.setFromTriplets(entries_.begin(), entries_.end());
        result.quads = std::move(quads_);
        return result;
    }

private:
    void add_vertex(int v) {
        const std::vector<int> star = connectivity_.star(v);
        const auto n = static_cast<double>(star.size());
        const double unit = 1 / (n * (n + 5));
        entries_.emplace_back(v, v, n * n * unit);
        for (int h : star) {
            entries_.emplace_back(v, connectivity_.to(h), 4 * unit);
            entries_.emplace_back(v, connectivity_.to(QuadConnectivity::next(h)), unit);
        }
    }

    /// Edges are numbered by their first side, so those of domain faces come first.
    void count_domain_edges() {
        while (domain_edges_ < connectivity_.edge_count() &&
               connectivity_.edge_side(domain_edges_) < 4 * mesh_.domain_face_count)
            ++domain_edges_;
    }

    /// Number of the point at (i, j) / parts of a face.
    int number(int face, int i, int j) const {
        const auto between = [](int a, int n) { return a > 0 && a < n; };
        if (between(i, parts_) && between(j, parts_))
            return mesh_.domain_vertex_count + (parts_ - 1) * domain_edges_ +
                   (parts_ - 1) * ((parts_ - 1) * face + j - 1) + i - 1;
        if (j == 0 && i < parts_)
            return on_side(4 * face, i);
        if (i == parts_ && j < parts_)
            return on_side(4 * face + 1, j);
        if (j == parts_ && i > 0)
            return on_side(4 * face + 2, parts_ - i);
        return on_side(4 * face + 3, parts_ - j);
    }

    /// Step 0 is the start of the side.
    int on_side(int side, int step) const {
        if (step == 0)
            return connectivity_.from(side);
        const int edge = connectivity_.edge(side);
        const int along = connectivity_.edge_side(edge) == side ? step : parts_ - step;
        return mesh_.domain_vertex_count + (parts_ - 1) * edge + along - 1;
    }

    void add_points_between() {
        Quadrature<Vec2> grid;
        std::vector<std::array<int, 2>> steps;
        for (int j = 0; j <= parts_; ++j)
            for (int i = 0; i <= parts_; ++i)
                if (i % parts_ != 0 || j % parts_ != 0) {
                    grid.points.emplace_back(static_cast<double>(i) / parts_, static_cast<double>(j) / parts_);
                    steps.push_back({i, j});
                }
        grid.weights.assign(grid.points.size(), 1 / static_cast<double>(grid.points.size()));
        const SurfaceBasis basis = surface_basis(mesh_, grid);
        std::vector<bool> done;
        for (int f = 0; f < mesh_.domain_face_count; ++f)
            for (std::size_t p = 0; p < steps.size(); ++p) {
                const auto row = static_cast<std::size_t>(number(f, steps[p][0], steps[p][1]));
                done.resize(std::max(done.size(), row + 1), false);
                if (done[row])
                    continue;
                done[row] = true;
                const auto weights = basis.stencil(f).value.col(static_cast<Eigen::Index>(p));
                const auto points = basis.control_points(f);
                for (std::size_t k = 0; k < points.size(); ++k)
                    if (const double weight = weights[static_cast<Eigen::Index>(k)]; weight != 0)
                        entries_.emplace_back(static_cast<int>(row), points[k], weight);
            }
    }

    void add_quads(int f) {
        for (int j = 0; j < parts_; ++j)
            for (int i = 0; i < parts_; ++i)
                quads_.push_back({number(f, i, j), number(f, i + 1, j), number(f, i + 1, j + 1), number(f, i, j + 1)});
    }

    const ControlMesh& mesh_;
    QuadConnectivity connectivity_;
    int parts_;
    int domain_edges_ = 0;
    std::vector<Eigen::Triplet<double>> entries_;
    std::vector<Quad> quads_;
};

} // namespace

LimitPoints limit_points(const ControlMesh& mesh, int parts_a_side) {
    assert(parts_a_side >= 1);
    return PointMaker(mesh, parts_a_side).run();
}

} // namespace plisse
