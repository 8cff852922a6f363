#include <plisse/contact/contact.h>

#include <atomic>
#include <cassert>
#include <cmath>
#include <utility>

#include <plisse/contact/active_set.h>
#include <plisse/contact/candidates.h>
#include <plisse/contact/pair_energy.h>

namespace plisse {

namespace {

/// Lowers `least` to `value`. The least of all values does not depend on the order of the calls.
void lower(std::atomic<double>& least, double value) {
    double seen = least.load(std::memory_order_relaxed);
    while (value < seen && !least.compare_exchange_weak(seen, value, std::memory_order_relaxed)) {
    }
}

bool same(const Positions& a, const Positions& b) {
    return a.cols() == b.cols() && a == b;
}

} // namespace

struct Contact::State {
    State(CollisionMesh collision_mesh, const ContactOptions& contact_options)
        : mesh(std::move(collision_mesh)), options(contact_options), candidates(mesh, options.reach(), options.self),
          active(mesh, options) {}

    /// Brings the active set to x.
    void evaluate(const Positions& x);
    /// Largest t in [0, length] up to which all candidates of one kind stay far enough apart on the way from
    /// sweep_start along d, whose boxes reach to sweep_end.
    double safe_length(StencilKind kind, const Positions& x, const Positions& d, double length) const;
    double safe_length_of(StencilKind kind, int candidate, const Positions& x, const Positions& d, double length) const;
    LimitingPair limiting_pair(StencilKind kind, int candidate, const Positions& x, double step) const;
    /// Adds block by block what pairs[begin ...] contribute, the results being in `hessians`.
    void scatter_hessians(std::size_t begin, std::size_t count, NewtonSystem& system) const;

    CollisionMesh mesh;
    ContactOptions options;
    Candidates candidates;
    ActiveSet active;
    Positions active_at{3, 0}; ///< where the active set was found
    Positions sweep_start, sweep_end;
    double sweep_length = 1; ///< from sweep_start to sweep_end, as a share of the motion
    bool sweeps_begin_at_x = true;
    Candidates::Drift start_drift, sweep_drift; ///< of sweep_start alone, and of the whole way
    std::vector<Vec12> gradients;
    std::vector<Mat12> hessians;
    std::vector<Edge> coupled_pairs;
    PhaseTimes own_times; ///< takes the times nobody asked for
    PhaseTimes* times = &own_times;
};

void Contact::State::evaluate(const Positions& x) {
    assert(x.cols() == mesh.rest.cols());
    if (same(x, active_at))
        return;
    if (!candidates.contain(x)) {
        const PhaseScope scope(*times, Phase::broad_phase);
        candidates.find_around(x);
    } else if (candidates.have_drifted(x)) {
        const PhaseScope scope(*times, Phase::broad_phase);
        candidates.measure(x);
    }
    active.find(candidates, x);
    active_at = x;
}

double Contact::State::safe_length_of(StencilKind kind, int candidate, const Positions& x, const Positions& d,
                                      double length) const {
    const double reach = options.reach();
    if (candidates.least_distance(kind, candidate, sweep_drift) >= reach)
        return length;
    const auto vertices = candidates.vertices(kind, candidate);
    const Stencil at_x = gather(x, vertices), motion = gather(d, vertices);
    const auto is_safe = [&](double distance, double least) {
        return sweeps_begin_at_x &&
               keeps_apart(kind, at_x, motion, distance, options.kept_distance(distance, least), length);
    };
    // What is kept of a longer distance, or from a lesser least one, leaves more room.
    if (is_safe(candidates.least_distance(kind, candidate, start_drift), options.enforced * options.thickness))
        return length;
    const Stencil start = gather(sweep_start, vertices);
    const double sweep_squared = squared_sweep_distance(kind, start, gather(sweep_end, vertices));
    if (sweep_squared >= reach * reach)
        return length;
    const double least = active.least_distance(kind, candidate, candidates);
    const double distance = std::sqrt(squared_distance(kind, at_x));
    if (is_safe(distance, least))
        return length;
    return safe_step(kind, start, motion, options.kept_distance(distance, least), length);
}

double Contact::State::safe_length(StencilKind kind, const Positions& x, const Positions& d, double length) const {
    std::atomic<double> least{length};
    parallel_for(candidates.size(kind), 256, [&](int i) {
        const double end = least.load(std::memory_order_relaxed);
        lower(least, safe_length_of(kind, i, x, d, end));
    });
    return least.load();
}

Contact::Contact(CollisionMesh mesh, const ContactOptions& options)
    : state_(std::make_unique<State>(std::move(mesh), options)) {
    assert(options.distance > 0 && options.thickness >= 0 && options.stiffness > 0 && options.ccd_ratio > 0 &&
           options.ccd_ratio < 1);
}

Contact::~Contact() = default;

const CollisionMesh& Contact::mesh() const {
    return state_->mesh;
}
const ContactOptions& Contact::options() const {
    return state_->options;
}
void Contact::set_times(PhaseTimes* times) {
    state_->times = times;
}

void Contact::forget() {
    state_->candidates.forget();
    state_->active_at.resize(3, 0);
}

double Contact::value(const Positions& x) {
    const PhaseScope scope(*state_->times, Phase::contact);
    state_->evaluate(x);
    return state_->active.energy();
}

void Contact::add_gradient(const Positions& x, Positions& gradient) {
    const PhaseScope scope(*state_->times, Phase::contact);
    state_->evaluate(x);
    const auto& pairs = state_->active.pairs();
    auto& gradients = state_->gradients;
    gradients.resize(pairs.size());
    parallel_for(static_cast<int>(pairs.size()), 128, [&](int i) {
        const auto p = static_cast<std::size_t>(i);
        gradients[p] = pair_gradient(pairs[p].parameters, pairs[p].separation, gather(x, pairs[p].vertices));
    });
    for (std::size_t p = 0; p < pairs.size(); ++p)
        for (int i = 0; i < 4; ++i)
            gradient.col(pairs[p].vertices[static_cast<std::size_t>(i)]) += gradients[p].segment<3>(3 * i);
}

const std::vector<Edge>& Contact::coupled_pairs(const Positions& x) {
    const PhaseScope scope(*state_->times, Phase::contact);
    state_->evaluate(x);
    auto& coupled = state_->coupled_pairs;
    coupled.clear();
    for (const ActivePair& pair : state_->active.pairs()) {
        const std::size_t first = pair.kind == StencilKind::edge_edge ? 2 : 1; // corners of the first primitive
        for (std::size_t i = 0; i < first; ++i)
            for (std::size_t j = first; j < 4; ++j)
                coupled.push_back({pair.vertices[i], pair.vertices[j]});
    }
    return coupled;
}

void Contact::State::scatter_hessians(std::size_t begin, std::size_t count, NewtonSystem& system) const {
    for (std::size_t k = 0; k < count; ++k) {
        const ActivePair& pair = active.pairs()[begin + k];
        for (int j = 0; j < 4; ++j)
            for (int i = 0; i < 4; ++i) {
                const int row = pair.vertices[static_cast<std::size_t>(i)];
                const int column = pair.vertices[static_cast<std::size_t>(j)];
                const auto block = hessians[k].block<3, 3>(3 * i, 3 * j);
                if (row >= column && (block.array() != 0).any())
                    system.add_block(row, column, block);
            }
    }
}

void Contact::add_hessian(const Positions& x, NewtonSystem& system, bool project) {
    const PhaseScope scope(*state_->times, Phase::contact);
    state_->evaluate(x);
    const auto& pairs = state_->active.pairs();
    auto& hessians = state_->hessians;
    const auto projected_hessian_of =
        state_->options.hessian == HessianKind::projected ? pair_projected_hessian : pair_gauss_newton_hessian;
    const auto hessian_of = project ? projected_hessian_of : pair_hessian;
    constexpr std::size_t batch_size = 1024; // blocks of a batch stay in the cache until they are scattered
    for (std::size_t begin = 0; begin < pairs.size(); begin += batch_size) {
        const std::size_t count = std::min(batch_size, pairs.size() - begin);
        hessians.resize(std::max(hessians.size(), count));
        parallel_for(static_cast<int>(count), 32, [&](int i) {
            const ActivePair& pair = pairs[begin + static_cast<std::size_t>(i)];
            hessians[static_cast<std::size_t>(i)] =
                hessian_of(pair.parameters, pair.separation, gather(x, pair.vertices));
        });
        state_->scatter_hessians(begin, count, system);
    }
}

double Contact::max_step(const Positions& x, const Positions& d) {
    assert(x.allFinite() && d.allFinite());
    State& s = *state_;
    const PhaseScope scope(*s.times, Phase::ccd);
    double done = 0, share = 1;
    while (done < 1) {
        s.sweeps_begin_at_x = done == 0;
        s.sweep_start = x + done * d;
        s.sweep_end = x + d;
        double until = 1;
        if (!s.candidates.contain(s.sweep_start) || !s.candidates.contain(s.sweep_end)) {
            const PhaseScope broad_phase(*s.times, Phase::broad_phase);
            share = s.candidates.find_along(s.sweep_start, d, std::min(share, 1 - done));
            until = share < 1 - done ? done + share : 1;
            s.sweep_end = x + until * d;
        }
        s.candidates.find_drift(s.sweep_start, s.sweep_start, s.start_drift);
        s.candidates.find_drift(s.sweep_start, s.sweep_end, s.sweep_drift);
        s.sweep_length = until - done;
        double length = s.safe_length(StencilKind::point_triangle, x, d, s.sweep_length);
        length = s.safe_length(StencilKind::edge_edge, x, d, length);
        if (length < s.sweep_length)
            return done + length;
        done = until;
    }
    return 1;
}

LimitingPair Contact::State::limiting_pair(StencilKind kind, int candidate, const Positions& x, double step) const {
    const Stencil stencil = gather(x, candidates.vertices(kind, candidate));
    const Separation separation = separate(kind, stencil);
    return {kind, candidates.primitives(kind, candidate), step, separation.offset.norm(),
            midpoint(separation, stencil)};
}

std::optional<LimitingPair> Contact::limiting_pair(const Positions& x, const Positions& d) {
    const double step = max_step(x, d);
    if (step == 1)
        return std::nullopt;
    // Sweep and candidates are now those of the part of the way on which the step ends.
    const State& s = *state_;
    double least = s.sweep_length;
    std::pair limiting{StencilKind::point_triangle, 0};
    for (const StencilKind kind : {StencilKind::point_triangle, StencilKind::edge_edge})
        for (int i = 0; i < s.candidates.size(kind); ++i)
            if (const double length = s.safe_length_of(kind, i, x, d, s.sweep_length); length < least) {
                least = length;
                limiting = {kind, i};
            }
    return s.limiting_pair(limiting.first, limiting.second, x, step);
}

double Contact::min_gap(const Positions& x) {
    const PhaseScope scope(*state_->times, Phase::contact);
    state_->evaluate(x);
    return state_->active.least_gap();
}

double Contact::least_thickness_share(const Positions& x) {
    const PhaseScope scope(*state_->times, Phase::contact);
    state_->evaluate(x);
    return state_->active.least_thickness_share();
}

void Contact::enforce(double share_of_thickness, double stiffness_factor) {
    assert(share_of_thickness >= 0 && share_of_thickness <= 1 && stiffness_factor > 0);
    state_->options.enforced = share_of_thickness;
    ContactOptions options = state_->options;
    options.stiffness *= stiffness_factor;
    state_->active.set_options(options);
    state_->active_at.resize(3, 0);
}

const std::vector<ActivePair>& Contact::active_pairs(const Positions& x) {
    const PhaseScope scope(*state_->times, Phase::contact);
    state_->evaluate(x);
    return state_->active.pairs();
}

int Contact::active_pair_count(const Positions& x) {
    return static_cast<int>(active_pairs(x).size());
}

} // namespace plisse
