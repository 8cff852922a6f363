#include <plisse/decimate/joint_flattening.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace plisse {

namespace {

constexpr int local_i = 0, local_j = 1, local_k = 2, local_ring = 3;
constexpr double least_twice_area = 1e-10; // the edge (i, j) having length 1
constexpr double least_chart_quality = 0.01;
constexpr double angle_tolerance = 1e-8;

/// Solves the symmetric system by elimination without pivots: rows of n unknowns with the right side behind them, of
/// which only the upper triangle is read. The solution replaces the right side. False when it is not positive definite.
bool eliminate(double* system, int n) {
    const int stride = n + 1;
    for (int k = 0; k < n; ++k) {
        const double* pivot_row = system + k * stride;
        const double pivot = pivot_row[k];
        if (!(pivot > 0))
            return false;
        for (int i = k + 1; i < n; ++i) {
            if (pivot_row[i] == 0)
                continue;
            const double factor = pivot_row[i] / pivot;
            double* row = system + i * stride;
            for (int j = i; j <= n; ++j)
                row[j] -= factor * pivot_row[j];
        }
    }
    for (int k = n - 1; k >= 0; --k) {
        double* row = system + k * stride;
        for (int j = k + 1; j < n; ++j)
            row[n] -= row[j] * system[j * stride + n];
        row[n] /= row[k];
    }
    return true;
}

} // namespace

bool JointFlattening::flatten(const Patch& patch, const DynamicFaces& faces, const Positions& rest, Alias alias,
                              Chart& chart) {
    lay_out(patch, faces, rest);
    assemble();
    if (!patch.is_curve_edge()) {
        const Constraint constraint{.alias = alias};
        if (!solve(constraint) || !is_valid(constraint))
            return false;
        keep(alias, chart);
        return true;
    }
    find_beyond(patch);
    const std::array<Constraint, 3> candidates{
        {{.alias = Alias::i, .straight_j = true},
         {.alias = Alias::j, .straight_i = true},
         {.alias = Alias::none, .straight_i = true, .straight_j = true, .straight_k = true}}};
    double least = std::numeric_limits<double>::infinity();
    for (const Constraint& candidate : candidates) {
        if (alias != Alias::none && candidate.alias != alias)
            continue;
        if (!solve(candidate) || !is_valid(candidate))
            continue;
        const double found = distortion();
        if (found < least) {
            least = found;
            keep(candidate.alias, chart);
        }
    }
    return std::isfinite(least);
}

void JointFlattening::lay_out(const Patch& patch, const DynamicFaces& faces, const Positions& rest) {
    count_ = local_ring + static_cast<int>(patch.places.size());
    sheet_count_ = patch.sheet_count;
    triangles_.clear();
    const auto add = [&](const Face& face, int sheet) {
        if (sheet == Patch::at_rest)
            return;
        const Vec3 edge = rest.col(face[1]) - rest.col(face[0]);
        const Vec3 other = rest.col(face[2]) - rest.col(face[0]);
        const double length = edge.norm();
        Triangle& triangle = triangles_.emplace_back();
        triangle.sheet = sheet;
        triangle.length = length;
        triangle.x = edge.dot(other) / length;
        triangle.y = edge.cross(other).norm() / length;
        for (std::size_t c = 0; c < 3; ++c)
            triangle.corner[c] = face[c] == patch.i   ? local_i
                                 : face[c] == patch.j ? local_j
                                 : face[c] == patch.k ? local_k
                                                      : local_ring + patch.place(sheet, face[c]);
    };
    std::size_t place = 0;
    for (const auto* before : {&patch.dead_faces, &patch.faces_of_i, &patch.faces_of_j})
        for (int f : *before)
            add(faces.face(f), patch.sheets[place++]);
    for (std::size_t n = 0; n < patch.after.size(); ++n)
        add(patch.after[n], patch.sheet_of_after(n));
}

void JointFlattening::find_beyond(const Patch& patch) {
    const auto find = [&](int vertex, std::vector<int>& places) {
        places.clear();
        for (int n = 0; n < static_cast<int>(patch.places.size()); ++n)
            if (patch.places[n] == vertex)
                places.push_back(local_ring + n);
    };
    find(patch.beyond_i, beyond_i_);
    find(patch.beyond_j, beyond_j_);
}

void JointFlattening::assemble() {
    std::fill_n(real_.begin(), count_ * count_, 0.0);
    std::fill_n(imaginary_.begin(), count_ * count_, 0.0);
    for (const Triangle& t : triangles_) {
        const std::array<double, 3> re{t.x - t.length, -t.x, t.length}, im{t.y, -t.y, 0};
        const double weight = 1 / (t.length * t.y);
        for (std::size_t a = 0; a < 3; ++a)
            for (std::size_t b = 0; b < 3; ++b) {
                const int place = t.corner[a] * count_ + t.corner[b];
                real_[place] += weight * (re[a] * re[b] + im[a] * im[b]);
                imaginary_[place] += weight * (re[a] * im[b] - im[a] * re[b]);
            }
    }
}

int JointFlattening::number_unknowns(const Constraint& constraint) {
    std::fill_n(unknown_.begin(), 2 * count_, 0);
    std::fill_n(coordinate_.begin(), 2 * count_, 0.0);
    coordinate_[2 * local_j] = 1;
    for (int fixed : {local_i, local_j})
        unknown_[2 * fixed] = unknown_[2 * fixed + 1] = -1;
    if (constraint.alias != Alias::none) {
        unknown_[2 * local_k] = unknown_[2 * local_k + 1] = -1;
        coordinate_[2 * local_k] = constraint.alias == Alias::j ? 1 : 0;
    }
    if (constraint.straight_k)
        unknown_[2 * local_k + 1] = -1;
    const std::array<std::pair<bool, const std::vector<int>*>, 2> beyond{
        {{constraint.straight_i, &beyond_i_}, {constraint.straight_j, &beyond_j_}}};
    constexpr int shared = -2;
    for (const auto& [straight, places] : beyond)
        for (std::size_t n = 0; straight && n < places->size(); ++n) {
            unknown_[2 * (*places)[n] + 1] = -1;
            if (n > 0)
                unknown_[2 * (*places)[n]] = shared;
        }
    int unknowns = 0;
    for (int c = 0; c < 2 * count_; ++c)
        if (unknown_[c] >= 0)
            unknown_[c] = unknowns++;
    for (const auto& [straight, places] : beyond)
        for (std::size_t n = 1; straight && n < places->size(); ++n)
            unknown_[2 * (*places)[n]] = unknown_[2 * places->front()];
    return unknowns;
}

void JointFlattening::fill_system(int unknowns) {
    const int stride = unknowns + 1;
    std::fill_n(system_.begin(), unknowns * stride, 0.0);
    const auto add = [&](int row_coordinate, int column_coordinate, double entry) {
        const int row = unknown_[row_coordinate], column = unknown_[column_coordinate];
        if (row < 0)
            return;
        if (column < 0)
            system_[row * stride + unknowns] -= entry * coordinate_[column_coordinate];
        else
            system_[row * stride + column] += entry;
    };
    for (int a = 0; a < count_; ++a)
        for (int b = 0; b < count_; ++b) {
            const double re = real_[a * count_ + b], im = imaginary_[a * count_ + b];
            add(2 * a, 2 * b, re);
            add(2 * a, 2 * b + 1, -im);
            add(2 * a + 1, 2 * b, im);
            add(2 * a + 1, 2 * b + 1, re);
        }
}

bool JointFlattening::solve(const Constraint& constraint) {
    const int unknowns = number_unknowns(constraint);
    fill_system(unknowns);
    if (!eliminate(system_.data(), unknowns))
        return false;
    for (int c = 0; c < 2 * count_; ++c)
        if (unknown_[c] >= 0)
            coordinate_[c] = system_[unknown_[c] * (unknowns + 1) + unknowns];
    return true;
}

bool JointFlattening::is_valid(const Constraint& constraint) {
    return runs_straight(constraint) && triangles_are_sound();
}

/// A curve that should be straight may not double back.
bool JointFlattening::runs_straight(const Constraint& constraint) const {
    const auto u = [&](int vertex) { return coordinate_[2 * vertex]; };
    if (constraint.straight_i && !(u(beyond_i_.front()) < std::min(0.0, u(local_k))))
        return false;
    return !constraint.straight_j || u(beyond_j_.front()) > std::max(1.0, u(local_k));
}

bool JointFlattening::triangles_are_sound() {
    angles_.assign(static_cast<std::size_t>(local_ring * sheet_count_), 0.0);
    for (const Triangle& t : triangles_) {
        std::array<Vec2, 3> p;
        for (std::size_t c = 0; c < 3; ++c)
            p[c] = Vec2(coordinate_[2 * t.corner[c]], coordinate_[2 * t.corner[c] + 1]);
        const Vec2 a = p[1] - p[0], b = p[2] - p[0];
        const double twice_area = a.x() * b.y() - a.y() * b.x();
        const double edges_squared = a.squaredNorm() + b.squaredNorm() + (p[2] - p[1]).squaredNorm();
        if (!(twice_area > least_twice_area) ||
            !(2 * std::sqrt(3.0) * twice_area >= least_chart_quality * edges_squared))
            return false;
        for (std::size_t c = 0; c < 3; ++c)
            if (t.corner[c] < local_ring) {
                const Vec2 along = p[(c + 1) % 3] - p[c], back = p[(c + 2) % 3] - p[c];
                angles_[local_ring * t.sheet + t.corner[c]] += std::atan2(twice_area, along.dot(back));
            }
    }
    return std::all_of(angles_.begin(), angles_.end(),
                       [](double angle) { return angle <= 2 * std::numbers::pi + angle_tolerance; });
}

double JointFlattening::distortion() const {
    double sum = 0;
    for (const Triangle& t : triangles_) {
        std::array<Vec2, 3> p;
        for (std::size_t c = 0; c < 3; ++c)
            p[c] = Vec2(coordinate_[2 * t.corner[c]], coordinate_[2 * t.corner[c] + 1]);
        Mat2 chart, laid_out;
        chart << p[1] - p[0], p[2] - p[0];
        laid_out << t.length, t.x, 0, t.y;
        const Mat2 map = laid_out * chart.inverse();
        const double square = map.squaredNorm(), determinant = map.determinant();
        const double root = std::sqrt(std::max(0.0, square * square - 4 * determinant * determinant));
        sum += (square + root) / (2 * determinant); // largest over smallest singular value
    }
    return sum;
}

void JointFlattening::keep(Alias alias, Chart& chart) const {
    const auto point = [&](int vertex) { return Vec2(coordinate_[2 * vertex], coordinate_[2 * vertex + 1]); };
    chart.alias = alias;
    chart.k = point(local_k);
    chart.ring.clear();
    for (int vertex = local_ring; vertex < count_; ++vertex)
        chart.ring.push_back(point(vertex));
}

} // namespace plisse
