#include <plisse/drive/refine.h>

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include <plisse/base/parallel.h>
#include <plisse/drive/batch_motion.h>
#include <plisse/drive/limit_relaxation.h>
#include <plisse/drive/patch_relaxation.h>
#include <plisse/drive/run_fraction.h>
#include <plisse/drive/safe_perturbation.h>
#include <plisse/drive/subdivided_state.h>

namespace plisse {

namespace {

std::size_t at(int index) {
    return static_cast<std::size_t>(index);
}

/// One batch of independent expansions on an expanding mesh.
class BatchExpansion {
public:
    BatchExpansion(ExpandingMesh& mesh, const ContactSettings& contact, Context& context)
        : mesh_(mesh), thickness_(contact.thickness), gap_(contact.distance + 2 * contact.thickness),
          context_(context) {}

    /// Undoes the records; returns one that no rung of the ladder could make safe, or -1.
    int expand(const std::vector<int>& records, RefinementReport& report) {
        const int failed = split_apart(records, report);
        if (failed >= 0)
            return failed;
        const BatchMotionResult motion = move_batch(mesh_, records, {gap_, least_gap(), least_gap() + thickness_});
        report.stopped += motion.stopped_vertices;
        for (int c : motion.tight_records) {
            relax_patch(mesh_, patch_vertices(mesh_, record(c)), least_gap(), context_);
            ++report.relaxed;
        }
        report.min_gap = std::min(report.min_gap, motion.min_gap);
        return -1;
    }

private:
    const Collapse& record(int c) const { return mesh_.discretization().hierarchy().collapses[at(c)]; }
    double least_gap() const { return 1e-3 * gap_; }

    int split_apart(const std::vector<int>& records, RefinementReport& report) {
        const int count = static_cast<int>(records.size());
        std::vector<double> radius(records.size());
        parallel_for(count, 4, [&](int r) { radius[at(r)] = safe_radius(mesh_, record(records[at(r)])); });
        for (int c : records)
            mesh_.split(record(c));
        std::vector<Rung> rungs(records.size());
        parallel_for(count, 4, [&](int r) {
            const int c = records[at(r)];
            rungs[at(r)] = perturb(mesh_, record(c), radius[at(r)], static_cast<std::uint64_t>(c));
        });
        for (int r = 0; r < count; ++r)
            if (rungs[at(r)] == Rung::failed)
                mesh_.merge(record(records[at(r)]));
            else
                update_boxes(records[at(r)]);
        for (int r = 0; r < count; ++r) {
            Rung& rung = rungs[at(r)];
            if (rung == Rung::failed)
                rung = relax_and_retry(records[at(r)]);
            if (rung == Rung::failed)
                return records[at(r)];
            ++report.expansions;
            report.first_try += rung == Rung::toward_target;
            report.sampled += rung == Rung::sampled;
            report.relaxed += rung == Rung::relaxed;
        }
        return -1;
    }

    /// Rung 4: gives the patch room while it is still collapsed, then tries again.
    Rung relax_and_retry(int c) {
        relax_patch(mesh_, patch_vertices(mesh_, record(c)), gap_, context_);
        const double radius = safe_radius(mesh_, record(c));
        mesh_.split(record(c));
        const Rung rung = perturb(mesh_, record(c), radius, static_cast<std::uint64_t>(c) + 1);
        update_boxes(c);
        return rung == Rung::failed ? Rung::failed : Rung::relaxed;
    }

    void update_boxes(int c) {
        for (int v : {record(c).i, record(c).j})
            mesh_.update_boxes(mesh_.faces().vertex_faces(v), [&](int w) {
                return Box{mesh_.position(w), mesh_.position(w)};
            });
    }

    ExpandingMesh& mesh_;
    double thickness_, gap_;
    Context& context_;
};

/// Per vertex of the level after `from`: whether it has come with it.
std::vector<std::uint8_t> new_vertices(const Discretization& discretization, int from) {
    const std::vector<int>& before = discretization.mesh(from).vertex_ids;
    std::vector<std::uint8_t> is_new;
    for (int id : discretization.mesh(from + 1).vertex_ids)
        is_new.push_back(!std::binary_search(before.begin(), before.end(), id));
    return is_new;
}

/// Undoes all collapses on the way to the next level. Empty when that was cancelled, or failed with a message.
Positions expand(const Discretization& discretization, int from, const Positions& x, double t, Context& context,
                 RefineResult& result) {
    const HierarchyLevel& coarse = discretization.mesh(from);
    ExpandingMesh mesh(discretization, from, x, t);
    BatchExpansion expansion(mesh, discretization.model().contact, context);
    result.report.colors = static_cast<int>(coarse.batches.size());
    result.report.min_gap = std::numeric_limits<double>::infinity();
    Progress shown;
    shown.level = from + 1;
    shown.level_count = discretization.finest() + 1;
    shown.phase = "refine";
    shown.step_count = static_cast<int>(coarse.batches.size());
    shown.time = t;
    shown.duration = discretization.model().solve.duration;
    const RunFraction run(discretization.model(), discretization.finest() + 1);
    for (const std::vector<int>& batch : coarse.batches) {
        if (context.cancelled())
            return {};
        const int failed = expansion.expand(batch, result.report);
        if (failed >= 0) {
            const Collapse& record = discretization.hierarchy().collapses[at(failed)];
            result.message = fmt::format("no safe direction was found to split the vertex at ({:.6g}, {:.6g}, {:.6g}) "
                                         "on the way from level {} to level {}",
                                         mesh.position(record.i).x(), mesh.position(record.i).y(),
                                         mesh.position(record.i).z(), from, from + 1);
            return {};
        }
        ++shown.step;
        shown.fraction = run.in_refinement(from + 1, shown.step / static_cast<double>(coarse.batches.size()));
        context.on_progress(shown);
    }
    return mesh.level_positions(from + 1);
}

Positions subdivide(const Discretization& discretization, int from, const Positions& x, double t,
                    RefinementReport& report) {
    SubdividedState state = subdivide_state(discretization, from, x, t);
    report.expansions = report.first_try = state.new_vertices;
    report.colors = 1;
    report.stopped = state.stopped_vertices;
    report.min_gap = state.min_gap;
    return std::move(state.positions);
}

} // namespace

RefineResult refine(const Discretization& discretization, int from, const Positions& x, double t, Context& context,
                    double stiffness_factor) {
    const Stopwatch watch;
    RefineResult result;
    result.report.from = from;
    result.report.to = from + 1;
    Positions expanded = discretization.hierarchy().is_subdivided()
                             ? subdivide(discretization, from, x, t, result.report)
                             : expand(discretization, from, x, t, context, result);
    if (!result.message.empty())
        return result;
    if (context.cancelled()) {
        result.cancelled = true;
        return result;
    }
    const LimitRelaxationResult relaxed = relax_to_strain_limits(
        discretization, from + 1, new_vertices(discretization, from), expanded, context, stiffness_factor);
    if (context.cancelled()) {
        result.cancelled = true;
        return result;
    }
    result.report.over_limit = relaxed.over_limit;
    result.report.strain_limit_iterations = relaxed.iterations;
    result.message = relaxed.message;
    result.complete = relaxed.within;
    if (result.complete)
        result.positions = expanded;
    result.report.total_seconds = watch.seconds();
    return result;
}

} // namespace plisse
