#include <plisse/subdivide/limit_stencils.h>

#include <cassert>
#include <vector>

#include <plisse/subdivide/catmull_clark_step.h>
#include <plisse/subdivide/face_ring.h>

namespace plisse {

namespace {

/// Divides a face and fills the columns of its stencil.
class StencilMaker {
public:
    StencilMaker(int control_points, std::span<const Vec2> points) {
        const auto count = static_cast<Eigen::Index>(points.size());
        for (Eigen::MatrixXd* m :
             {&stencil_.value, &stencil_.du, &stencil_.dv, &stencil_.duu, &stencil_.duv, &stencil_.dvv})
            m->resize(control_points, count);
    }

    struct Sample {
        Vec2 at; ///< in the part at hand
        Eigen::Index column;
    };

    /// weights: of the face's control points for each of the ring of the part, at `scale` parts to a unit.
    void add(const std::array<int, 4>& valence, const Eigen::MatrixXd& weights, const std::vector<Sample>& samples,
             double scale) {
        if (FaceRing{valence, {}}.is_ordinary()) {
            for (const Sample& sample : samples)
                add_ordinary(weights, sample, scale);
            return;
        }
        assert(scale < 1e15);
        const ControlMesh mesh = ring_mesh(valence);
        const CatmullClarkStep step = catmull_clark_step(mesh);
        const QuadConnectivity connectivity = step.fine.connectivity();
        const Eigen::MatrixXd fine = step.weights * weights;
        for (int quarter = 0; quarter < 4; ++quarter) {
            const std::vector<Sample> inside = samples_in(quarter, samples);
            if (inside.empty())
                continue;
            const FaceRing ring = face_ring(step.fine, connectivity, quarter);
            add(ring.valence, fine(ring.points, Eigen::all), inside, 2 * scale);
        }
    }

    FaceStencil result() { return std::move(stencil_); }

private:
    static std::vector<Sample> samples_in(int quarter, const std::vector<Sample>& samples) {
        const Vec2 origin(quarter == 1 || quarter == 2 ? 1 : 0, quarter >= 2 ? 1 : 0);
        std::vector<Sample> inside;
        for (const Sample& sample : samples) {
            const Vec2 which(sample.at.x() > 0.5 ? 1 : 0, sample.at.y() > 0.5 ? 1 : 0);
            if (which == origin)
                inside.push_back({2 * sample.at - origin, sample.column});
        }
        return inside;
    }

    void add_ordinary(const Eigen::MatrixXd& weights, const Sample& sample, double scale) {
        const auto [u, v] = std::array<double, 2>{sample.at.x(), sample.at.y()};
        const std::array<Eigen::Vector4d, 3> along_u = {bspline(u), bspline_derivative(u),
                                                        bspline_second_derivative(u)};
        const std::array<Eigen::Vector4d, 3> along_v = {bspline(v), bspline_derivative(v),
                                                        bspline_second_derivative(v)};
        const auto fill = [&](Eigen::MatrixXd& m, std::size_t in_u, std::size_t in_v, double factor) {
            Eigen::Matrix<double, 16, 1> local;
            for (std::size_t p = 0; p < 16; ++p)
                local[static_cast<Eigen::Index>(p)] =
                    along_u[in_u][ordinary_places[p][0] + 1] * along_v[in_v][ordinary_places[p][1] + 1];
            m.col(sample.column) = factor * (weights.transpose() * local);
        };
        fill(stencil_.value, 0, 0, 1);
        fill(stencil_.du, 1, 0, scale);
        fill(stencil_.dv, 0, 1, scale);
        fill(stencil_.duu, 2, 0, scale * scale);
        fill(stencil_.duv, 1, 1, scale * scale);
        fill(stencil_.dvv, 0, 2, scale * scale);
    }

    FaceStencil stencil_;
};

} // namespace

Eigen::Vector4d bspline(double t) {
    const double s = 1 - t;
    return Eigen::Vector4d(s * s * s, 4 - 3 * t * t * (1 + s), 4 - 3 * s * s * (1 + t), t * t * t) / 6;
}

Eigen::Vector4d bspline_derivative(double t) {
    const double s = 1 - t;
    return Eigen::Vector4d(-s * s, t * (3 * t - 4), s * (4 - 3 * s), t * t) / 2;
}

Eigen::Vector4d bspline_second_derivative(double t) {
    return {1 - t, 3 * t - 2, 1 - 3 * t, t};
}

FaceStencil face_stencil(const std::array<int, 4>& valence, std::span<const Vec2> points) {
    const int count = ring_mesh(valence).vertex_count;
    std::vector<StencilMaker::Sample> samples;
    for (std::size_t p = 0; p < points.size(); ++p)
        samples.push_back({points[p], static_cast<Eigen::Index>(p)});
    StencilMaker maker(count, points);
    maker.add(valence, Eigen::MatrixXd::Identity(count, count), samples, 1);
    return maker.result();
}

} // namespace plisse
