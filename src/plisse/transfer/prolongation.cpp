#include <plisse/transfer/prolongation.h>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
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

ProlongationWeights barycentric_weights(const std::vector<Anchor>& anchors, const std::vector<Face>& faces,
                                        Eigen::Index coarse_count) {
    ProlongationWeights weights(static_cast<Eigen::Index>(anchors.size()), coarse_count);
    std::vector<Eigen::Triplet<double>> entries;
    for (std::size_t i = 0; i < anchors.size(); ++i)
        for (int k = 0; k < 3 && anchors[i].face >= 0; ++k)
            entries.emplace_back(static_cast<int>(i), faces[at(anchors[i].face)][at(k)], anchors[i].weights[k]);
    weights.setFromTriplets(entries.begin(), entries.end());
    return weights;
}

Positions without_weights(const ProlongationWeights& weights, const Positions& fine_rest) {
    Positions result = Positions::Zero(3, fine_rest.cols());
    for (int i = 0; i < fine_rest.cols(); ++i)
        if (weights.outerIndexPtr()[i] == weights.outerIndexPtr()[i + 1])
            result.col(i) = fine_rest.col(i);
    return result;
}

/// One group for the fine vertices of a face: what any of them depends on, which is much the same. One each for those
/// without an anchor.
Stencils stencils_of(const ProlongationWeights& weights, const std::vector<Anchor>& anchors, std::size_t faces) {
    Stencils stencils;
    std::vector<int> group_of_face(faces, -1);
    std::vector<std::vector<int>> groups;
    for (int i = 0; i < weights.rows(); ++i) {
        const int face = anchors[at(i)].face;
        int group = face < 0 ? -1 : group_of_face[at(face)];
        for (ProlongationWeights::InnerIterator entry(weights, i); entry; ++entry) {
            if (group < 0) {
                group = static_cast<int>(groups.size());
                groups.emplace_back();
                if (face >= 0)
                    group_of_face[at(face)] = group;
            }
            groups[at(group)].push_back(static_cast<int>(entry.col()));
        }
        stencils.group_of.push_back(weights.outerIndexPtr()[i] == weights.outerIndexPtr()[i + 1] ? -1 : group);
    }
    for (std::vector<int>& group : groups) {
        std::sort(group.begin(), group.end());
        group.erase(std::unique(group.begin(), group.end()), group.end());
        stencils.coarse.insert(stencils.coarse.end(), group.begin(), group.end());
        stencils.starts.push_back(static_cast<int>(stencils.coarse.size()));
    }
    return stencils;
}

} // namespace

Prolongation::Prolongation(ProlongationWeights weights, const std::vector<Face>& coarse_faces,
                           std::vector<Anchor> anchors, const Positions& fine_rest)
    : anchors_(std::move(anchors)), barycentric_(barycentric_weights(anchors_, coarse_faces, weights.cols())),
      weights_(std::move(weights)), unanchored_(without_weights(weights_, fine_rest)),
      stencils_(stencils_of(weights_, anchors_, coarse_faces.size())), arm_starts_(anchors_.size() + 1, 0) {
    assert(anchors_.size() == static_cast<std::size_t>(weights_.rows()));
}

Prolongation::Prolongation(const Positions& coarse_rest, std::vector<Face> coarse_faces, std::vector<Anchor> anchors,
                           const Positions& fine_rest, ProlongationOperator kind)
    : anchors_(std::move(anchors)), barycentric_(barycentric_weights(anchors_, coarse_faces, coarse_rest.cols())),
      weights_(barycentric_), unanchored_(without_weights(weights_, fine_rest)),
      coarse_faces_(std::move(coarse_faces)) {
    assert(anchors_.size() == static_cast<std::size_t>(fine_rest.cols()));
    assert(kind != ProlongationOperator::affine && kind != ProlongationOperator::loop);
    for (const Face& face : coarse_faces_) {
        const Vec3 origin = coarse_rest.col(face[0]);
        rest_inverse_.push_back(
            rest_edges(coarse_rest.col(face[1]) - origin, coarse_rest.col(face[2]) - origin).inverse());
    }
    const int faces = static_cast<int>(coarse_faces_.size());
    group_by(
        3 * faces, coarse_count(), [&](int c) { return coarse_faces_[at(c / 3)][at(c % 3)]; }, corners_of_vertex_,
        corner_starts_);

    std::vector<std::vector<int>> turning(at(faces));
    for (int f = 0; f < faces; ++f) {
        turning[at(f)] = turning_faces(f, kind);
        add_stencil(f, turning[at(f)]);
    }
    VecX star_areas = VecX::Zero(coarse_count());
    for (int f = 0; f < faces; ++f)
        for (int v : coarse_faces_[at(f)])
            star_areas[v] += rest_area(f);
    const std::vector<PolarFrame> rest_frames = frames(coarse_rest);
    arm_starts_.push_back(0);
    for (int i = 0; i < fine_count(); ++i) {
        const int face = anchors_[at(i)].face;
        stencils_.group_of.push_back(face);
        if (face >= 0)
            add_arms(i, fine_rest.col(i), coarse_rest, rest_frames, turning[at(face)], star_areas);
        arm_starts_.push_back(static_cast<int>(arms_.size()));
    }
    group_by(
        arm_starts_.back(), faces, [&](int a) { return arms_[at(a)].face; }, arms_of_face_, arms_of_face_starts_);
}

/// The faces with which fine vertices anchored in a face turn, itself first.
std::vector<int> Prolongation::turning_faces(int face, ProlongationOperator kind) const {
    if (kind == ProlongationOperator::intrinsic)
        return {};
    std::vector<int> result{face};
    if (kind == ProlongationOperator::shell)
        return result;
    for (int v : coarse_faces_[at(face)])
        for (int c = corner_starts_[at(v)]; c < corner_starts_[at(v) + 1]; ++c)
            if (const int other = corners_of_vertex_[at(c)] / 3; other != face)
                result.push_back(other);
    std::sort(result.begin() + 1, result.end());
    result.erase(std::unique(result.begin() + 1, result.end()), result.end());
    return result;
}

/// Of the face's group: its corners, then what else the turning faces have.
void Prolongation::add_stencil(int face, const std::vector<int>& turning) {
    const Face& corners = coarse_faces_[at(face)];
    std::vector<int> others;
    for (int f : turning)
        for (int v : coarse_faces_[at(f)])
            if (std::find(corners.begin(), corners.end(), v) == corners.end())
                others.push_back(v);
    std::sort(others.begin(), others.end());
    others.erase(std::unique(others.begin(), others.end()), others.end());
    stencils_.coarse.insert(stencils_.coarse.end(), corners.begin(), corners.end());
    stencils_.coarse.insert(stencils_.coarse.end(), others.begin(), others.end());
    stencils_.starts.push_back(static_cast<int>(stencils_.coarse.size()));
}

void Prolongation::add_arms(int fine, const Vec3& rest, const Positions& coarse_rest,
                            const std::vector<PolarFrame>& rest_frames, const std::vector<int>& turning,
                            const VecX& star_areas) {
    const Anchor& anchor = anchors_[at(fine)];
    const Face& corners = coarse_faces_[at(anchor.face)];
    const auto stencil = stencils_.group(anchor.face);
    Mat3 weighted_differences; // of the fine vertex from the corners
    for (int k = 0; k < 3; ++k)
        weighted_differences.col(k) = anchor.weights[k] * (rest - coarse_rest.col(corners[at(k)]));
    const Vec3 offset = weighted_differences.rowwise().sum();
    const double own_share = turning.size() == 1 ? 1 : 0.5;
    for (int f : turning) {
        const Face& face = coarse_faces_[at(f)];
        Vec3 vector = f == anchor.face ? Vec3(own_share * offset) : Vec3(Vec3::Zero());
        for (int k = 0; k < 3; ++k)
            if (const int v = corners[at(k)]; std::find(face.begin(), face.end(), v) != face.end())
                vector += (1 - own_share) * rest_area(f) / star_areas[v] * weighted_differences.col(k);
        const PolarFrame& frame = rest_frames[at(f)];
        Arm arm{fine, f, frame.normal.dot(vector), frame.rotation.transpose() * vector, {}};
        for (std::size_t k = 0; k < 3; ++k)
            arm.slots[k] = static_cast<int>(std::find(stencil.begin(), stencil.end(), face[k]) - stencil.begin());
        arms_.push_back(arm);
    }
}

double Prolongation::rest_area(int face) const {
    return 0.5 / rest_inverse_[at(face)].determinant();
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
    Positions fine = unanchored_ + (weights_ * coarse.transpose()).transpose();
    const std::vector<PolarFrame> frame_of = frames(coarse);
    parallel_for(fine_count(), grain, [&](int i) {
        for (int a = arm_starts_[at(i)]; a < arm_starts_[at(i) + 1]; ++a) {
            const Arm& arm = arms_[at(a)];
            const PolarFrame& frame = frame_of[at(arm.face)];
            fine.col(i) += frame.normal * arm.normal + frame.rotation * arm.in_plane;
        }
    });
    return fine;
}

// With g_k the gradient of corner k's barycentric function, moving corner k by d changes F by d g_k^T, and
//     dn = -R S^-1 g_k (n.d),   dR t = (R J t) (q_k.d) / tr S + n (g_k.S^-1 t) (n.d),
// where J turns by a right angle and q_k = g_kx R_2 - g_ky R_1 (DESIGN.md section 5).
ProlongationJacobian Prolongation::jacobian(const Positions& coarse) const {
    const std::vector<PolarFrame> frame_of = frames(coarse);
    ProlongationJacobian result(stencils_);
    parallel_for(fine_count(), grain, [&](int i) {
        const auto stencil = stencils_.of(i);
        auto rows = result.rows(i);
        for (ProlongationWeights::InnerIterator entry(weights_, i); entry; ++entry) {
            const auto slot = std::find(stencil.begin(), stencil.end(), static_cast<int>(entry.col()));
            rows.middleCols<3>(3 * (slot - stencil.begin())) = entry.value() * Mat3::Identity();
        }
        for (int a = arm_starts_[at(i)]; a < arm_starts_[at(i) + 1]; ++a) {
            const Arm& arm = arms_[at(a)];
            const PolarFrame& frame = frame_of[at(arm.face)];
            const Vec2& t = arm.in_plane;
            const Vec2 inverse_t = frame.stretch_inverse * t;
            const Vec3 turned = frame.rotation * Vec2(-t.y(), t.x()) / frame.stretch_trace;
            const auto gradients = shape_gradients(rest_inverse_[at(arm.face)]);
            for (std::size_t k = 0; k < 3; ++k) {
                const Vec2& g = gradients[k];
                const Vec3 q = g.x() * frame.rotation.col(1) - g.y() * frame.rotation.col(0);
                const Vec3 tilt = frame.rotation * (frame.stretch_inverse * g);
                rows.middleCols<3>(3 * arm.slots[k]) +=
                    turned * q.transpose() +
                    (g.dot(inverse_t) * frame.normal - arm.normal * tilt) * frame.normal.transpose();
            }
        }
    });
    return result;
}

/// What the gradients at the ends of a face's arms leave at its corners.
Mat3 Prolongation::turned_gradient(int face, const Positions& coarse, const Positions& fine_gradient) const {
    const PolarFrame frame = polar_frame(deformation_gradient(face, coarse));
    Vec3 tilt_sum = Vec3::Zero(); // of an arm's normal part times the gradient at its end, projected below
    double turn_sum = 0;
    Vec2 bend_sum = Vec2::Zero();
    for (int c = arms_of_face_starts_[at(face)]; c < arms_of_face_starts_[at(face) + 1]; ++c) {
        const Arm& arm = arms_[at(arms_of_face_[at(c)])];
        const Vec3 g = fine_gradient.col(arm.fine);
        const Vec2& t = arm.in_plane;
        tilt_sum += arm.normal * g;
        turn_sum += (frame.rotation * Vec2(-t.y(), t.x())).dot(g);
        bend_sum += frame.normal.dot(g) * t;
    }
    const Vec2 along_normal = frame.stretch_inverse * (bend_sum - frame.rotation.transpose() * tilt_sum);
    const auto gradients = shape_gradients(rest_inverse_[at(face)]);
    Mat3 corners;
    for (int k = 0; k < 3; ++k) {
        const Vec2& g = gradients[at(k)];
        const Vec3 q = g.x() * frame.rotation.col(1) - g.y() * frame.rotation.col(0);
        corners.col(k) = frame.normal * g.dot(along_normal) + q * (turn_sum / frame.stretch_trace);
    }
    return corners;
}

Positions Prolongation::pull_back(const Positions& coarse, const Positions& fine_gradient) const {
    Positions result = pull_back_lagged(fine_gradient);
    if (arms_.empty())
        return result;
    std::vector<Mat3> corner_gradients(coarse_faces_.size());
    parallel_for(static_cast<int>(coarse_faces_.size()), grain,
                 [&](int f) { corner_gradients[at(f)] = turned_gradient(f, coarse, fine_gradient); });
    parallel_for(coarse_count(), grain, [&](int v) {
        for (int c = corner_starts_[at(v)]; c < corner_starts_[at(v) + 1]; ++c) {
            const int corner = corners_of_vertex_[at(c)];
            result.col(v) += corner_gradients[at(corner / 3)].col(corner % 3);
        }
    });
    return result;
}

Positions Prolongation::pull_back_lagged(const Positions& fine_gradient) const {
    return (weights_.transpose() * fine_gradient.transpose()).transpose();
}

VecX Prolongation::pull_back_values(const VecX& fine_values) const {
    return barycentric_.transpose() * fine_values;
}

} // namespace plisse
