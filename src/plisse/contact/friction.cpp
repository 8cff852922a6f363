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

/// How hard pairs press, N. What is counted off at a point is shared out over its other pairs, so that a vertex in the
/// fold of two faces rubs with the force that it presses with.
std::vector<double> normal_forces(std::span<const ActivePair> active, const Positions& x) {
    std::vector<double> forces;
    for (const ActivePair& pair : active)
        forces.push_back(pair_normal_force(pair.parameters, pair.separation, gather(x, pair.vertices)));
    for (std::size_t begin = 0, end = 0; begin < active.size(); begin = end) {
        double pressing = 0, counted_off = 0;
        for (end = begin; end == begin || (end < active.size() && of_one_point(active[begin], active[end])); ++end)
            (forces[end] > 0 ? pressing : counted_off) += forces[end];
        const double left = pressing > 0 ? std::max(0.0, 1 + counted_off / pressing) : 0;
        for (std::size_t p = begin; p < end; ++p)
            forces[p] = left * std::max(0.0, forces[p]);
    }
    return forces;
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

/// What a pair has given up so far.
Vec3 Friction::slipped(const ActivePair& pair, const Positions& x) const {
    const RubbingPair wanted{pair.kind, pair.primitives};
    const auto known = std::lower_bound(memory_.pairs.begin(), memory_.pairs.end(), wanted, comes_before);
    if (known != memory_.pairs.end() && !comes_before(wanted, *known))
        return known->slipped;
    if (!memory_.knows_pairs)
        return Vec3::Zero();
    return (gather(x, pair.vertices) - gather(memory_.reference, pair.vertices)) * pair.separation.weights;
}

Friction::Contact Friction::contact(const ActivePair& pair, const Positions& x) const {
    Contact contact;
    contact.vertices = pair.vertices;
    contact.weights = pair.separation.weights;
    contact.normal = pair.separation.offset.normalized();
    contact.slipped = slipped(pair, x);
    contact.origin = gather(memory_.reference, pair.vertices) * contact.weights + contact.slipped;
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
        contacts_.push_back(contact(active[p], x));
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
        const Contact now = contact(pair, x);
        const Vec3 u = sliding(now, x);
        const double given_up = std::max(0.0, 1 - options_.slip / u.norm()); // -infinity without motion
        pairs.push_back({pair.kind, pair.primitives, now.slipped + given_up * u});
    }
    std::sort(pairs.begin(), pairs.end(), comes_before);
    memory_.pairs = std::move(pairs);
    memory_.knows_pairs = true;
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
