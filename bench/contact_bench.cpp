#include <benchmark/benchmark.h>

#include <cmath>
#include <ctime>
#include <utility>

#include <plisse/base/parallel.h>
#include <plisse/contact/active_set.h>

#include "crowded_run.h"

// Kernels of contact on what a crowded run gave them to do, and what they take of it. `each_ns` is the CPU time of one
// item; `calls` how many of them one Newton iteration takes; `share` the percentage of an iteration's CPU time that
// they come to. Kernels call each other, so shares do not add up.

namespace plisse {
namespace {

/// A pair on its way.
struct MovingPair {
    Stencil x, d;
    double distance = 0, kept = 0; ///< at x, and to be kept
    double end = 1;                ///< what the pairs before it have left of the step
};

/// The work of one kind of pair: what passes each of the screens of Contact::max_step.
struct PairWork {
    std::vector<MovingPair> screened; ///< not far enough apart by their drift: a bound on their distance, and later the
                                      ///< distance itself, is held against their speed
    std::vector<MovingPair> swept;    ///< nor by their speed: their boxes are looked at
    std::vector<MovingPair> near;     ///< nor by their boxes: their distance is found
    std::vector<MovingPair> clear, colliding; ///< nor by distance and speed: safe_step finds no limit, or one
    std::vector<ActivePair> active;           ///< pairs that repel at the queries' x
    std::vector<Stencil> active_at;
};

/// What the whole run asked for, by pairs and by searches.
struct ContactWork {
    std::array<PairWork, 2> of_kind;
    std::array<double, 2> separations{}; ///< found for the energy
    double candidates_seen = 0;          ///< for the energy
    std::vector<const StepQuery*> searches_along;
    double found_along = 0, found_around = 0; ///< candidates
    const PairWork& of(StencilKind kind) const { return of_kind[static_cast<std::size_t>(kind)]; }
};

constexpr StencilKind kinds[] = {StencilKind::point_triangle, StencilKind::edge_edge};

double count(const auto& items) {
    return static_cast<double>(items.size());
}

double size_of(const Candidates& candidates) {
    return candidates.size(kinds[0]) + candidates.size(kinds[1]);
}

/// Goes once more through what the run asked for, in the order of Contact::max_step. Pairs are found along whole steps:
/// the run has none so long that it would be cut for memory.
class Replay {
public:
    explicit Replay(const CrowdedRun& run)
        : run_(run), candidates_(run.mesh, run.options.reach(), run.options.self), active_(run.mesh, run.options) {
        const Positions* last = nullptr;
        for (const StepQuery& query : run.queries) {
            filter(query);
            if (!last || *last != query.x) // else a longer step is tried from the same place
                note_active(query.x);
            last = &query.x;
            for (const Positions& trial : query.trials)
                evaluate(trial);
        }
    }
    ContactWork take_work() { return std::move(work_); }

private:
    void filter(const StepQuery& query) {
        const Positions end = query.x + query.d;
        if (!candidates_.contain(query.x) || !candidates_.contain(end)) {
            candidates_.find_along(query.x, query.d, 1);
            work_.searches_along.push_back(&query);
            work_.found_along += size_of(candidates_);
        }
        candidates_.find_drift(query.x, query.x, start_drift_);
        candidates_.find_drift(query.x, end, drift_);
        double length = 1;
        for (const StencilKind kind : kinds)
            for (int i = 0; i < candidates_.size(kind); ++i)
                if (candidates_.least_distance(kind, i, drift_) < run_.options.reach())
                    filter_pair(kind, i, query, length);
    }

    void filter_pair(StencilKind kind, int candidate, const StepQuery& query, double& length) {
        PairWork& work = work_.of_kind[static_cast<std::size_t>(kind)];
        const auto vertices = candidates_.vertices(kind, candidate);
        MovingPair pair{gather(query.x, vertices), gather(query.d, vertices), 0, 0, length};
        const auto is_safe = [&](double distance, double least) {
            pair.distance = distance;
            pair.kept = run_.options.kept_distance(distance, least);
            work.screened.push_back(pair);
            return keeps_apart(kind, pair.x, pair.d, pair.distance, pair.kept, length);
        };
        if (is_safe(candidates_.least_distance(kind, candidate, start_drift_),
                    run_.options.enforced * run_.options.thickness))
            return;
        work.swept.push_back(pair);
        const double reach = run_.options.reach();
        if (squared_sweep_distance(kind, pair.x, pair.x + pair.d) >= reach * reach)
            return;
        work.near.push_back(pair);
        if (is_safe(std::sqrt(squared_distance(kind, pair.x)), active_.least_distance(kind, candidate, candidates_)))
            return;
        const double step = safe_step(kind, pair.x, pair.d, pair.kept, length);
        (step < length ? work.colliding : work.clear).push_back(pair);
        length = step;
    }

    void evaluate(const Positions& x) {
        if (!candidates_.contain(x)) {
            candidates_.find_around(x);
            work_.found_around += size_of(candidates_);
        } else if (candidates_.have_drifted(x)) {
            candidates_.measure(x);
        }
        work_.candidates_seen += size_of(candidates_);
        candidates_.find_drift(x, x, drift_);
        const double reach = run_.options.reach();
        for (const StencilKind kind : kinds)
            for (int i = 0; i < candidates_.size(kind); ++i) {
                if (candidates_.least_distance(kind, i, drift_) >= reach)
                    continue;
                const Stencil stencil = gather(x, candidates_.vertices(kind, i));
                work_.separations[static_cast<std::size_t>(kind)] +=
                    squared_sweep_distance(kind, stencil, stencil) < reach * reach;
            }
    }

    void note_active(const Positions& x) {
        active_.find(candidates_, x);
        for (const ActivePair& pair : active_.pairs()) {
            PairWork& work = work_.of_kind[static_cast<std::size_t>(pair.kind)];
            work.active.push_back(pair);
            work.active_at.push_back(gather(x, pair.vertices));
        }
    }

    const CrowdedRun& run_;
    Candidates candidates_;
    Candidates::Drift start_drift_, drift_;
    ActiveSet active_;
    ContactWork work_;
};

const ContactWork& contact_work() {
    static const ContactWork work = Replay(crowded_run()).take_work();
    return work;
}

StencilKind kind_of(const benchmark::State& state) {
    return static_cast<StencilKind>(state.range(0));
}

/// Runs pass() again and again. items: of one pass; calls: of such items in the whole recorded run.
template <typename Pass>
void run_passes(benchmark::State& state, double items, double calls, const Pass& pass) {
    const ThreadLimit one_thread(1);
    const CrowdedRun& run = crowded_run();
    const std::clock_t start = std::clock();
    for (auto _ : state)
        pass();
    const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    const double each = seconds / (items * static_cast<double>(state.iterations()));
    state.counters["each_ns"] = 1e9 * each;
    state.counters["calls"] = run.per_iteration(calls);
    state.counters["share"] = 100 * each * run.per_iteration(calls) / run.seconds;
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(items));
}

/// Runs evaluate(item) over all items, in the run's order.
template <typename Item, typename Evaluate>
void run_items(benchmark::State& state, const std::vector<Item>& items, double calls, const Evaluate& evaluate) {
    run_passes(state, count(items), calls, [&] {
        for (const Item& item : items) {
            auto result = evaluate(item);
            benchmark::DoNotOptimize(result);
        }
    });
}

void sweep_distance(benchmark::State& state) {
    const auto kind = kind_of(state);
    const auto& pairs = contact_work().of(kind).swept;
    run_items(state, pairs, count(pairs),
              [&](const MovingPair& pair) { return squared_sweep_distance(kind, pair.x, pair.x + pair.d); });
}

void distance(benchmark::State& state) {
    const auto kind = kind_of(state);
    const auto& pairs = contact_work().of(kind).near;
    run_items(state, pairs, count(pairs), [&](const MovingPair& pair) { return squared_distance(kind, pair.x); });
}

void speed_screen(benchmark::State& state) {
    const auto kind = kind_of(state);
    const auto& pairs = contact_work().of(kind).screened;
    run_items(state, pairs, count(pairs), [&](const MovingPair& pair) {
        return keeps_apart(kind, pair.x, pair.d, pair.distance, pair.kept, pair.end);
    });
}

void ccd(benchmark::State& state, const std::vector<MovingPair>& pairs) {
    const auto kind = kind_of(state);
    run_items(state, pairs, count(pairs),
              [&](const MovingPair& pair) { return safe_step(kind, pair.x, pair.d, pair.kept, pair.end); });
}
void ccd_clear(benchmark::State& state) {
    ccd(state, contact_work().of(kind_of(state)).clear);
}
void ccd_colliding(benchmark::State& state) {
    ccd(state, contact_work().of(kind_of(state)).colliding);
}

void separation(benchmark::State& state) {
    const auto kind = kind_of(state);
    run_items(state, contact_work().of(kind).active_at, contact_work().separations[static_cast<std::size_t>(kind)],
              [&](const Stencil& x) { return separate(kind, x); });
}

void distance_with_derivatives(benchmark::State& state) {
    const auto kind = kind_of(state);
    run_items(state, contact_work().of(kind).active_at, 0, [&](const Stencil& x) {
        const Separation s = separate(kind, x);
        return std::pair(squared_distance_gradient(s), squared_distance_hessian(s));
    });
}

/// Runs evaluate(pair, stencil) over the active pairs; share: of the iterations that do so.
template <typename Evaluate>
void run_active(benchmark::State& state, double share, const Evaluate& evaluate) {
    const PairWork& work = contact_work().of(kind_of(state));
    run_passes(state, count(work.active), share * count(work.active), [&] {
        for (std::size_t i = 0; i < work.active.size(); ++i) {
            auto result = evaluate(work.active[i], work.active_at[i]);
            benchmark::DoNotOptimize(result);
        }
    });
}

void energy_of_pair(benchmark::State& state) {
    run_active(state, 1,
               [](const ActivePair& p, const Stencil& x) { return pair_energy(p.parameters, p.separation, x); });
}
void gradient_of_pair(benchmark::State& state) {
    run_active(state, 1,
               [](const ActivePair& p, const Stencil& x) { return pair_gradient(p.parameters, p.separation, x); });
}
void exact_hessian_of_pair(benchmark::State& state) {
    run_active(state, crowded_run().per_iteration(crowded_run().exact_hessians),
               [](const ActivePair& p, const Stencil& x) { return pair_hessian(p.parameters, p.separation, x); });
}
void projected_hessian_of_pair(benchmark::State& state) {
    run_active(
        state, crowded_run().per_iteration(crowded_run().projected_hessians),
        [](const ActivePair& p, const Stencil& x) { return pair_projected_hessian(p.parameters, p.separation, x); });
}

Candidates new_candidates() {
    const CrowdedRun& run = crowded_run();
    return {run.mesh, run.options.reach(), run.options.self};
}

/// Runs search(candidates, query) over the queries. What it finds are the items; calls: how many the whole run found
/// so.
template <typename Search>
void run_searches(benchmark::State& state, const std::vector<const StepQuery*>& queries, double calls,
                  const Search& search) {
    Candidates candidates = new_candidates();
    double found = 0;
    for (const StepQuery* query : queries) {
        search(candidates, *query);
        found += size_of(candidates);
    }
    run_passes(state, found, calls, [&] {
        for (const StepQuery* query : queries)
            search(candidates, *query);
    });
}

void candidates_around(benchmark::State& state) {
    run_searches(state, contact_work().searches_along, contact_work().found_around,
                 [](Candidates& candidates, const StepQuery& query) { candidates.find_around(query.x); });
}
void candidates_along(benchmark::State& state) {
    run_searches(state, contact_work().searches_along, contact_work().found_along,
                 [](Candidates& candidates, const StepQuery& query) { candidates.find_along(query.x, query.d, 1); });
}

void active_set(benchmark::State& state) {
    constexpr std::size_t every = 10; // candidates of all queries would fill the memory
    const CrowdedRun& run = crowded_run();
    std::vector<Candidates> candidates;
    double seen = 0;
    for (std::size_t q = 0; q < run.queries.size(); q += every) {
        candidates.push_back(new_candidates());
        candidates.back().find_around(run.queries[q].x);
        seen += size_of(candidates.back());
    }
    ActiveSet active(run.mesh, run.options);
    run_passes(state, seen, contact_work().candidates_seen, [&] {
        for (std::size_t i = 0; i < candidates.size(); ++i)
            active.find(candidates[i], run.queries[every * i].x);
    });
}

/// Candidates and CCD together, as the solver calls them.
void step_filter(benchmark::State& state) {
    const CrowdedRun& run = crowded_run();
    Contact contact(run.mesh, run.options);
    run_passes(state, count(run.queries), count(run.queries), [&] {
        for (const StepQuery& query : run.queries)
            benchmark::DoNotOptimize(contact.max_step(query.x, query.d));
    });
}

/// Not measured anew: the recorded run's own time, and the percentage of each phase.
void newton_iteration(benchmark::State& state) {
    const CrowdedRun& run = crowded_run();
    for (auto _ : state)
        state.SetIterationTime(run.seconds);
    const double known = run.phases.total();
    for (int phase = 0; phase < phase_count; ++phase)
        if (const double seconds = run.phases[static_cast<Phase>(phase)]; seconds > 0)
            state.counters[phase_name(static_cast<Phase>(phase))] = 100 * seconds / known;
}

BENCHMARK(newton_iteration)->UseManualTime()->Iterations(1)->Unit(benchmark::kMillisecond);
BENCHMARK(step_filter);
BENCHMARK(candidates_around);
BENCHMARK(candidates_along);
BENCHMARK(active_set);
BENCHMARK(sweep_distance)->ArgName("edges")->Arg(0)->Arg(1);
BENCHMARK(distance)->ArgName("edges")->Arg(0)->Arg(1);
BENCHMARK(separation)->ArgName("edges")->Arg(0)->Arg(1);
BENCHMARK(distance_with_derivatives)->ArgName("edges")->Arg(0)->Arg(1);
BENCHMARK(speed_screen)->ArgName("edges")->Arg(0)->Arg(1);
BENCHMARK(ccd_clear)->ArgName("edges")->Arg(0)->Arg(1);
BENCHMARK(ccd_colliding)->ArgName("edges")->Arg(0)->Arg(1);
BENCHMARK(energy_of_pair)->ArgName("edges")->Arg(0)->Arg(1);
BENCHMARK(gradient_of_pair)->ArgName("edges")->Arg(0)->Arg(1);
BENCHMARK(exact_hessian_of_pair)->ArgName("edges")->Arg(0)->Arg(1);
BENCHMARK(projected_hessian_of_pair)->ArgName("edges")->Arg(0)->Arg(1);

} // namespace
} // namespace plisse
