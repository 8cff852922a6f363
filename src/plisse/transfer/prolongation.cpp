#include <plisse/transfer/prolongation.h>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <cassert>

#include <plisse/base/parallel.h>

namespace plisse {

namespace {

constexpr int grain = 256;

std::size_t at(int index) {
    return static_cast<std::size_t>(index);
}

/// Groups items by key in [0, groups): items of group g are items[starts[g] .. starts[g + 1]), ascending.
template <typename Key>
void group_by(int count, int groups, const Key& key, std::vector<int>& items, std::vector<int>& starts) {
    starts.assign(at(groups) + 1, 0);
    for (int i = 0; i < count; ++i)
        if (key(i) >= 0)
            ++starts[at(key(i)) + 1];
    for (int g = 0; g < groups; ++g)
        starts[at(g) + 1] += starts[at(g)];
    items.resize(at(starts.back()));
    std::vector<int> next(starts.begin(), starts.end() - 1);
    for (int i = 0; i < count; ++i)
        if (key(i) >= 0)
            items[at(next[at(key(i))]++)] = i;
}

/// Rest edges in the triangle's own frame: first axis along the first edge (PSQ footnote 2).
Mat2 rest_edges(const Vec3& e1, const Vec3& e2) {
    const double length = e1.norm();
    Mat2 b;
    b << length, e1.dot(e2) / length, 0, e1.cross(e2).norm() / length;
    return b;
}

/// Gradients of the three barycentric functions in the rest frame.
std::array<Vec2, 3> shape_gradients(const Mat2& rest_inverse) {
    const Vec2 g1 = rest_inverse.row(0);
    const Vec2 g2 = rest_inverse.row(1);
    return {-g1 - g2, g1, g2};
}

} // namespace

Prolongation::Prolongation(const Positions& coarse_rest, std::vector<Face> coarse_faces, std::vector<Anchor> anchors,
                           const Positions& fine_rest, ProlongationOperator kind)
    : coarse_count_(static_cast<int>(coarse_rest.cols())), coarse_faces_(std::move(coarse_faces)),
      anchors_(std::move(anchors)), offsets_(Positions::Zero(3, fine_rest.cols())), fine_rest_(fine_rest) {
    assert(anchors_.size() == static_cast<std::size_t>(fine_rest.cols()));
    for (const Face& face : coarse_faces_) {
        const Vec3 origin = coarse_rest.col(face[0]);
        rest_inverse_.push_back(
            rest_edges(coarse_rest.col(face[1]) - origin, coarse_rest.col(face[2]) - origin).inverse());
    }
    const int faces = static_cast<int>(coarse_faces_.size());
    group_by(
        fine_count(), faces, [&](int i) { return anchors_[at(i)].face; }, fine_of_face_, fine_of_face_starts_);
    group_by(
        3 * faces, coarse_count_, [&](int c) { return coarse_faces_[at(c / 3)][at(c % 3)]; }, corners_of_vertex_,
        corner_starts_);
    if (kind == ProlongationOperator::intrinsic)
        return;
    const std::vector<PolarFrame> rest_frames = frames(coarse_rest);
    for (int i = 0; i < fine_count(); ++i) {
        const Anchor& anchor = anchors_[at(i)];
        if (anchor.face < 0)
            continue;
        const Face& face = coarse_faces_[at(anchor.face)];
        Vec3 difference = fine_rest.col(i);
        for (int k = 0; k < 3; ++k)
            difference -= anchor.weights[k] * coarse_rest.col(face[at(k)]);
        const PolarFrame& frame = rest_frames[at(anchor.face)];
        offsets_(0, i) = frame.normal.dot(difference);
        offsets_.col(i).tail<2>() = frame.rotation.transpose() * difference;
    }
}

Mat32 Prolongation::deformation_gradient(int face, const Positions& coarse) const {
    const Face& f = coarse_faces_[at(face)];
    Mat32 edges;
    edges << coarse.col(f[1]) - coarse.col(f[0]), coarse.col(f[2]) - coarse.col(f[0]);
    return edges * rest_inverse_[at(face)];
}

std::vector<PolarFrame> Prolongation::frames(const Positions& coarse) const {
    std::vector<PolarFrame> result(coarse_faces_.size());
    parallel_for(static_cast<int>(coarse_faces_.size()), grain,
                 [&](int f) { result[at(f)] = polar_frame(deformation_gradient(f, coarse)); });
    return result;
}

Positions Prolongation::apply(const Positions& coarse) const {
    Positions fine(3, fine_count());
    const std::vector<PolarFrame> frame_of = frames(coarse);
    parallel_for(fine_count(), grain, [&](int i) {
        const Anchor& anchor = anchors_[at(i)];
        if (anchor.face < 0) {
            fine.col(i) = fine_rest_.col(i);
            return;
        }
        const Face& face = coarse_faces_[at(anchor.face)];
        const PolarFrame& frame = frame_of[at(anchor.face)];
        fine.col(i) = anchor.weights[0] * coarse.col(face[0]) + anchor.weights[1] * coarse.col(face[1]) +
                      anchor.weights[2] * coarse.col(face[2]) + frame.normal * offsets_(0, i) +
                      frame.rotation * offsets_.col(i).tail<2>();
    });
    return fine;
}

// With g_k the gradient of corner k's barycentric function, moving corner k by d changes F by d g_k^T, and
//     dn = -R S^-1 g_k (n.d),   dR t = (R J t) (q_k.d) / tr S + n (g_k.S^-1 t) (n.d),
// where J turns by a right angle and q_k = g_kx R_2 - g_ky R_1 (DESIGN.md section 5).
std::vector<Prolongation::Block> Prolongation::jacobian(const Positions& coarse) const {
    const std::vector<PolarFrame> frame_of = frames(coarse);
    std::vector<Block> blocks(anchors_.size(), Block::Zero());
    parallel_for(fine_count(), grain, [&](int i) {
        const Anchor& anchor = anchors_[at(i)];
        if (anchor.face < 0)
            return;
        const PolarFrame& frame = frame_of[at(anchor.face)];
        const double gamma = offsets_(0, i);
        const Vec2 t = offsets_.col(i).tail<2>();
        const Vec2 inverse_t = frame.stretch_inverse * t;
        const Vec3 turned = frame.rotation * Vec2(-t.y(), t.x()) / frame.stretch_trace;
        const auto gradients = shape_gradients(rest_inverse_[at(anchor.face)]);
        for (int k = 0; k < 3; ++k) {
            const Vec2& g = gradients[at(k)];
            const Vec3 q = g.x() * frame.rotation.col(1) - g.y() * frame.rotation.col(0);
            const Vec3 tilt = frame.rotation * (frame.stretch_inverse * g);
            blocks[at(i)].middleCols<3>(3 * k) =
                anchor.weights[k] * Mat3::Identity() + turned * q.transpose() +
                (g.dot(inverse_t) * frame.normal - gamma * tilt) * frame.normal.transpose();
        }
    });
    return blocks;
}

template <typename FaceGradient>
Positions Prolongation::gather(const FaceGradient& face_gradient) const {
    std::vector<Mat3> corner_gradients(coarse_faces_.size());
    parallel_for(static_cast<int>(coarse_faces_.size()), grain,
                 [&](int f) { corner_gradients[at(f)] = face_gradient(f); });
    Positions result = Positions::Zero(3, coarse_count_);
    parallel_for(coarse_count_, grain, [&](int v) {
        for (int c = corner_starts_[at(v)]; c < corner_starts_[at(v) + 1]; ++c) {
            const int corner = corners_of_vertex_[at(c)];
            result.col(v) += corner_gradients[at(corner / 3)].col(corner % 3);
        }
    });
    return result;
}

Positions Prolongation::pull_back(const Positions& coarse, const Positions& fine_gradient) const {
    return gather([&](int f) {
        const PolarFrame frame = polar_frame(deformation_gradient(f, coarse));
        Mat3 corners = Mat3::Zero();
        Vec3 tilt_sum = Vec3::Zero(); // sum of gamma g, projected below
        double turn_sum = 0;
        Vec2 bend_sum = Vec2::Zero();
        for (int c = fine_of_face_starts_[at(f)]; c < fine_of_face_starts_[at(f) + 1]; ++c) {
            const int i = fine_of_face_[at(c)];
            const Vec3 g = fine_gradient.col(i);
            const Vec2 t = offsets_.col(i).tail<2>();
            corners += g * anchors_[at(i)].weights.transpose();
            tilt_sum += offsets_(0, i) * g;
            turn_sum += (frame.rotation * Vec2(-t.y(), t.x())).dot(g);
            bend_sum += frame.normal.dot(g) * t;
        }
        const Vec2 along_normal = frame.stretch_inverse * (bend_sum - frame.rotation.transpose() * tilt_sum);
        const auto gradients = shape_gradients(rest_inverse_[at(f)]);
        for (int k = 0; k < 3; ++k) {
            const Vec2& g = gradients[at(k)];
            const Vec3 q = g.x() * frame.rotation.col(1) - g.y() * frame.rotation.col(0);
            corners.col(k) += frame.normal * g.dot(along_normal) + q * (turn_sum / frame.stretch_trace);
        }
        return corners;
    });
}

Positions Prolongation::pull_back_lagged(const Positions& fine_gradient) const {
    return gather([&](int f) {
        Mat3 corners = Mat3::Zero();
        for (int c = fine_of_face_starts_[at(f)]; c < fine_of_face_starts_[at(f) + 1]; ++c) {
            const int i = fine_of_face_[at(c)];
            corners += fine_gradient.col(i) * anchors_[at(i)].weights.transpose();
        }
        return corners;
    });
}

VecX Prolongation::pull_back_values(const VecX& fine_values) const {
    Positions packed = Positions::Zero(3, fine_count());
    packed.row(0) = fine_values.transpose();
    return pull_back_lagged(packed).row(0).transpose();
}

} // namespace plisse
