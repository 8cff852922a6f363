#include <plisse/contact/friction.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include <plisse/base/parallel.h>

namespace plisse {

namespace {

std::size_t at(int index) {
    return static_cast<std::size_t>(index);
}

/// f0 and its derivatives: value f0(y), pull f1(y) / y, rise f1'(y).
struct Smoothed {
    double value, pull, rise;
};

Smoothed smoothed(double y, double slip) {
    const double share = y / slip;
    if (share >= 1)
        return {y - slip / 3, 1 / y, 0};
    return {y * share * (1 - share / 3), (2 - share) / slip, 2 * (1 - share) / slip};
}

bool of_one_point(const ActivePair& a, const ActivePair& b) {
    return a.kind == StencilKind::point_triangle && b.kind == a.kind && a.primitives[0] == b.primitives[0];
}

/// Whether the place that one pair of a point is counted off for belongs to the face of another one.
bool lies_on_face_of(const ActivePair& counted_off, const ActivePair& other) {
    for (std::size_t i = 1; i < 4; ++i)
        if (counted_off.separation.weights[static_cast<int>(i)] != 0 &&
            std::find(other.vertices.begin() + 1, other.vertices.end(), counted_off.vertices[i]) ==
                other.vertices.end())
            return false;
    return true;
}

/// Takes what is counted off for the edge between two faces from these, in inverse proportion to how much harder each
/// presses: where an edge and a face come to be one place, and both pairs end, nothing is left of either.
void take_off(std::size_t counted_off, std::size_t begin, std::span<const ActivePair> active,
              const std::vector<double>& at_first, std::span<double> forces) {
    const double taken = -at_first[counted_off];
    const auto share = [&](std::size_t p) {
        const bool shares = at_first[p] > 0 && lies_on_face_of(active[counted_off], active[p]);
        return shares ? 1 / (std::abs(at_first[p] - taken) + 1e-9 * taken) : 0;
    };
    double shares = 0;
    for (std::size_t p = begin; p < begin + forces.size(); ++p)
        shares += share(p);
    if (shares == 0)
        return;
    forces[counted_off - begin] += taken;
    for (std::size_t p = begin; p < begin + forces.size(); ++p)
        forces[p - begin] -= taken * share(p) / shares;
}

/// How hard pairs press, N. What is counted off at a point is taken from its other pairs, so that a vertex in the fold
/// of two faces rubs with the force that it presses with: from those at the same place, and where it is more than they
/// have, from all in proportion.
std::vector<double> normal_forces(std::span<const ActivePair> active, const Positions& x) {
    std::vector<double> at_first;
    for (const ActivePair& pair : active)
        at_first.push_back(pair_normal_force(pair.parameters, pair.separation, gather(x, pair.vertices)));
    std::vector<double> forces = at_first;
    for (std::size_t begin = 0, end = 0; begin < active.size(); begin = end) {
        end = begin + 1;
        while (end < active.size() && of_one_point(active[begin], active[end]))
            ++end;
        const auto of_point = std::span(forces).subspan(begin, end - begin);
        for (std::size_t p = begin; p < end; ++p)
            if (at_first[p] < 0)
                take_off(p, begin, active, at_first, of_point);
        double pressing = 0, lacking = 0;
        for (const double force : of_point)
            (force > 0 ? pressing : lacking) += force;
        const double left = pressing > 0 ? std::max(0.0, 1 + lacking / pressing) : 0;
        for (double& force : of_point)
            force = left * std::max(0.0, force);
    }
    return forces;
}

/// How many of a stencil's vertices belong to its first primitive.
std::size_t first_count(StencilKind kind) {
    return kind == StencilKind::point_triangle ? 1 : 2;
}

/// How much of the place of a pair, both sides of it, lies on the primitives of a known one: 2 is all.
struct SharedPlace {
    double share = 0;
    double sign = 1; ///< -1 where sides are exchanged
};

SharedPlace shared_place(const ActivePair& pair, StencilKind kind, const std::array<int, 4>& known) {
    std::array<std::array<double, 2>, 2> shares{}; // of the pair's side, on the known one's side
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < 4; ++j)
            if (pair.vertices[i] == known[j])
                shares[i >= first_count(pair.kind)][j >= first_count(kind)] +=
                    std::abs(pair.separation.weights[static_cast<int>(i)]);
    const auto of_both = [](double a, double b) { return a > 0 && b > 0 ? a + b : 0; };
    const double straight = of_both(shares[0][0], shares[1][1]), exchanged = of_both(shares[0][1], shares[1][0]);
    return straight >= exchanged ? SharedPlace{straight, 1} : SharedPlace{exchanged, -1};
}

bool comes_before(const RubbingPair& a, const RubbingPair& b) {
    return std::tie(a.kind, a.primitives) < std::tie(b.kind, b.primitives);
}

} // namespace

Friction::Friction(const CollisionMesh& mesh, const FrictionOptions& options)
    : mesh_(mesh), options_(options), possible_(std::any_of(options.coefficients.begin(), options.coefficients.end(),
                                                            [](double mu) { return mu > 0; })) {}

double Friction::coefficient(const ActivePair& pair) const {
    const int a = mesh_.part[at(pair.vertices[0])], b = mesh_.part[at(pair.vertices[3])];
    return options_.coefficients[at(a) * mesh_.obstacle.size() + at(b)];
}

/// Pairs that are counted off pull; friction does not.
bool Friction::rubs(const ActivePair& pair) const {
    return pair.parameters.scale > 0 && coefficient(pair) > 0;
}

void Friction::begin(FrictionMemory memory) {
    memory_ = std::move(memory);
    pairs_at_.clear();
    for (int p = 0; p < static_cast<int>(memory_.pairs.size()); ++p)
        for (const int vertex : mesh_.stencil_vertices(memory_.pairs[at(p)].kind, memory_.pairs[at(p)].primitives))
            pairs_at_.emplace_back(vertex, p);
    std::sort(pairs_at_.begin(), pairs_at_.end());
}

Vec3 Friction::elastic_slip(const ActivePair& pair) const {
    const RubbingPair wanted{pair.kind, pair.primitives};
    const auto known = std::lower_bound(memory_.pairs.begin(), memory_.pairs.end(), wanted, comes_before);
    if (known != memory_.pairs.end() && !comes_before(wanted, *known))
        return known->elastic_slip;
    constexpr double least_share = 1; // that of one side alone
    double largest = least_share;
    Vec3 result = Vec3::Zero();
    for (std::size_t i = 0; i < first_count(pair.kind); ++i) {
        const std::pair<int, int> first{pair.vertices[i], 0};
        for (auto entry = std::lower_bound(pairs_at_.begin(), pairs_at_.end(), first);
             entry != pairs_at_.end() && entry->first == pair.vertices[i]; ++entry) {
            const RubbingPair& neighbour = memory_.pairs[at(entry->second)];
            const SharedPlace place =
                shared_place(pair, neighbour.kind, mesh_.stencil_vertices(neighbour.kind, neighbour.primitives));
            if (place.share > largest) {
                largest = place.share;
                result = place.sign * neighbour.elastic_slip;
            }
        }
    }
    return result;
}

Friction::Contact Friction::contact(const ActivePair& pair) const {
    Contact contact;
    contact.vertices = pair.vertices;
    contact.weights = pair.separation.weights;
    contact.normal = pair.separation.offset.normalized();
    contact.origin = gather(memory_.reference, pair.vertices) * contact.weights - elastic_slip(pair);
    return contact;
}

Vec3 Friction::sliding(const Contact& contact, const Positions& x) const {
    const Vec3 motion = gather(x, contact.vertices) * contact.weights - contact.origin;
    return motion - contact.normal.dot(motion) * contact.normal;
}

void Friction::lag(std::span<const ActivePair> active, const Positions& x, double grip, double share) {
    constexpr double least_share = 1e-3;
    for (Contact& contact : contacts_) {
        contact.limit *= 1 - share;
        contact.share *= 1 - share;
    }
    std::erase_if(contacts_, [](const Contact& contact) { return contact.share < least_share; });
    grip_ = grip;
    if (!possible_)
        return;
    if (memory_.reference.cols() == 0)
        memory_.reference = x;
    const std::vector<double> forces = normal_forces(active, x);
    for (std::size_t p = 0; p < active.size(); ++p) {
        if (!rubs(active[p]))
            continue;
        contacts_.push_back(contact(active[p]));
        contacts_.back().limit = share * grip_ * coefficient(active[p]) * forces[p];
        contacts_.back().share = share;
    }
}

void Friction::remember(std::span<const ActivePair> active, const Positions& x) {
    if (!possible_)
        return;
    std::vector<RubbingPair> pairs;
    for (const ActivePair& pair : active) {
        if (!rubs(pair))
            continue;
        const Vec3 u = sliding(contact(pair), x);
        const double kept = std::min(1.0, options_.slip / u.norm()); // all where there is no motion
        pairs.push_back({pair.kind, pair.primitives, kept * u});
    }
    std::sort(pairs.begin(), pairs.end(), comes_before);
    begin({x, std::move(pairs)});
}

double Friction::value(const Positions& x) const {
    return parallel_sum(static_cast<int>(contacts_.size()), [&](int c) {
        const Contact& contact = contacts_[at(c)];
        return contact.limit * smoothed(sliding(contact, x).norm(), options_.slip).value;
    });
}

void Friction::add_gradient(const Positions& x, Positions& gradient) const {
    for (const Contact& contact : contacts_) {
        const Vec3 u = sliding(contact, x);
        const Vec3 force = contact.limit * smoothed(u.norm(), options_.slip).pull * u;
        for (int i = 0; i < 4; ++i)
            gradient.col(contact.vertices[at(i)]) += contact.weights[i] * force;
    }
}

void Friction::append_coupled_pairs(std::vector<Edge>& pairs) const {
    for (const Contact& contact : contacts_)
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t j = i + 1; j < 4; ++j)
                if (contact.weights[static_cast<int>(i)] != 0 && contact.weights[static_cast<int>(j)] != 0)
                    pairs.push_back({contact.vertices[i], contact.vertices[j]});
}

void Friction::add_hessian(const Positions& x, NewtonSystem& system) const {
    for (const Contact& contact : contacts_) {
        const Vec3 u = sliding(contact, x);
        const double length = u.norm();
        const Smoothed f = smoothed(length, options_.slip);
        const Vec3& n = contact.normal;
        Mat3 stiffness = f.pull * (Mat3::Identity() - n * n.transpose());
        if (length > 0)
            stiffness += (f.rise - f.pull) / (length * length) * u * u.transpose();
        stiffness *= contact.limit;
        for (int j = 0; j < 4; ++j)
            for (int i = 0; i < 4; ++i) {
                const int row = contact.vertices[at(i)], column = contact.vertices[at(j)];
                const double weight = contact.weights[i] * contact.weights[j];
                if (row >= column && weight != 0)
                    system.add_block(row, column, weight * stiffness);
            }
    }
}

} // namespace plisse
