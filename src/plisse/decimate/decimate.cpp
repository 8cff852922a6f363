#include <plisse/decimate/decimate.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include <plisse/base/timing.h>
#include <plisse/decimate/batches.h>
#include <plisse/decimate/edge_collapser.h>
#include <plisse/decimate/hierarchy_statistics.h>
#include <plisse/decimate/point_carrier.h>

namespace plisse {

namespace {

/// Number of collapses that separate each level from the finest: sizes fall geometrically from what there was to what
/// was reached.
std::vector<int> level_cuts(const std::vector<int>& counted_left, int levels) {
    std::vector<int> cuts(levels, 0);
    const double initial = counted_left.front(), least = counted_left.back();
    for (int l = 0; l + 1 < levels && initial > 0; ++l) {
        const double size = initial * std::pow(least / initial, static_cast<double>(levels - 1 - l) / (levels - 1));
        const auto reached =
            std::find_if(counted_left.begin(), counted_left.end(), [&](int left) { return left <= std::round(size); });
        cuts[l] = static_cast<int>(reached - counted_left.begin());
    }
    cuts[0] = levels > 1 ? static_cast<int>(counted_left.size()) - 1 : 0;
    return cuts;
}

std::vector<int> wanted_sizes(int initial, const DecimationOptions& options) {
    std::vector<int> sizes(options.levels, initial);
    const double ratio = std::min(1.0, static_cast<double>(options.coarsest_vertices) / std::max(1, initial));
    for (int l = 0; l + 1 < options.levels; ++l)
        sizes[l] = static_cast<int>(
            std::round(initial * std::pow(ratio, static_cast<double>(options.levels - 1 - l) / (options.levels - 1))));
    return sizes;
}

/// Numbers of the ids that satisfy present(id), ascending.
template <typename Present>
std::vector<int> present_ids(int count, const Present& present) {
    std::vector<int> ids;
    for (int id = 0; id < count; ++id)
        if (present(id))
            ids.push_back(id);
    return ids;
}

std::vector<int> index_of_ids(const std::vector<int>& ids, int id_count) {
    std::vector<int> index(id_count, -1);
    for (std::size_t n = 0; n < ids.size(); ++n)
        index[ids[n]] = static_cast<int>(n);
    return index;
}

/// Replays the collapses from the finest level down, carries points, and stores levels on the way.
class LevelBuilder {
public:
    LevelBuilder(const DecimationInput& input, const CollapseSequence& sequence, DecimationSummary& summary)
        : input_(input), sequence_(sequence), summary_(summary),
          faces_(input.faces, static_cast<int>(sequence.vertices.size())),
          finest_points_(all_vertices(input), faces_.vertex_id_count(), faces_.face_id_count()),
          level_points_(finest_points_) {
        for (const VertexState& state : sequence.vertices)
            on_curve_.push_back(state.on_curve);
    }

    HierarchyLevel finest() const {
        HierarchyLevel level = make_level(all_vertices(input_));
        level.to_finest = level.on_input = anchors(finest_points_, input_.part.size(), level);
        return level;
    }

    /// Makes the next collapses and describes the level they lead to. Sets the anchors of the finer level on it.
    HierarchyLevel next(int first, int last, const HierarchyLevel& finer) {
        for (int c = first; c < last; ++c)
            carry(sequence_.collapses[c], sequence_.charts[c]);
        HierarchyLevel level =
            make_level(present_ids(faces_.vertex_id_count(), [&](int v) { return faces_.has_vertex(v); }));
        level.to_finest = anchors(finest_points_, input_.part.size(), level);
        level.to_next = anchors(level_points_, finer.vertex_ids.size(), level);
        level.batches = expansion_batches(sequence_.collapses, first, last, faces_.vertex_id_count());
        count(level_points_);
        level_points_ = PointCarrier(level.vertex_ids, faces_.vertex_id_count(), faces_.face_id_count());
        return level;
    }

    /// Undoes all collapses and finds where the vertices of the levels come to lie. cuts: collapses before each level.
    void locate_on_finest(std::vector<HierarchyLevel>& levels, const std::vector<int>& cuts) {
        std::vector<PointCarrier> points; // of the levels met so far, from the coarsest
        const auto meet_levels = [&](int collapses) {
            while (points.size() + 1 < levels.size() && cuts[points.size()] == collapses)
                points.emplace_back(levels[points.size()].vertex_ids, faces_.vertex_id_count(), faces_.face_id_count());
        };
        for (int c = cuts.front(); c > 0; --c) {
            meet_levels(c);
            const Collapse& collapse = sequence_.collapses[c - 1];
            faces_.expand(collapse);
            triangles_.lay_out(collapse, sequence_.charts[c - 1], faces_, on_curve_);
            for (PointCarrier& carrier : points)
                carrier.carry_back(collapse, sequence_.charts[c - 1], triangles_);
        }
        meet_levels(0);
        for (std::size_t l = 0; l < points.size(); ++l) {
            levels[l].on_input = anchors(points[l], levels[l].vertex_ids.size(), levels.back());
            count(points[l]);
        }
    }

    void finish() const { count(finest_points_); }

private:
    static std::vector<int> all_vertices(const DecimationInput& input) {
        std::vector<int> all(input.part.size());
        std::iota(all.begin(), all.end(), 0);
        return all;
    }

    void carry(const Collapse& collapse, const Chart& chart) {
        triangles_.lay_out(collapse, chart, faces_, on_curve_);
        finest_points_.carry(collapse, chart, triangles_);
        level_points_.carry(collapse, chart, triangles_);
        faces_.collapse(collapse);
    }

    HierarchyLevel make_level(std::vector<int> vertex_ids) const {
        HierarchyLevel level;
        level.vertex_ids = std::move(vertex_ids);
        level.face_ids = present_ids(faces_.face_id_count(), [&](int f) { return faces_.has_face(f); });
        const std::vector<int> index = index_of_ids(level.vertex_ids, faces_.vertex_id_count());
        for (int f : level.face_ids) {
            const Face& face = faces_.face(f);
            level.faces.push_back({index[face[0]], index[face[1]], index[face[2]]});
        }
        level.rest.resize(3, static_cast<Eigen::Index>(level.vertex_ids.size()));
        for (std::size_t v = 0; v < level.vertex_ids.size(); ++v) {
            const int id = level.vertex_ids[v];
            level.rest.col(static_cast<Eigen::Index>(v)) = sequence_.rest.col(id);
            level.part.push_back(sequence_.vertices[id].part);
            level.label.push_back(sequence_.vertices[id].label);
        }
        return level;
    }

    std::vector<Anchor> anchors(const PointCarrier& points, std::size_t count, const HierarchyLevel& level) const {
        const std::vector<int> face_index = index_of_ids(level.face_ids, faces_.face_id_count());
        std::vector<Anchor> result;
        for (std::size_t point = 0; point < count; ++point) {
            Anchor& anchor = result.emplace_back(points.anchor(static_cast<int>(point), faces_));
            if (anchor.face >= 0)
                anchor.face = face_index[anchor.face];
        }
        return result;
    }

    void count(const PointCarrier& points) const {
        summary_.relocations += points.relocations();
        summary_.location_errors += points.errors();
        summary_.worst_location = std::min(summary_.worst_location, points.worst());
    }

    const DecimationInput& input_;
    const CollapseSequence& sequence_;
    DecimationSummary& summary_;
    DynamicFaces faces_;
    std::vector<bool> on_curve_;
    PointCarrier finest_points_, level_points_;
    ChartTriangles triangles_;
};

std::vector<HierarchyLevel> build_levels(const DecimationInput& input, const CollapseSequence& sequence, int levels,
                                         DecimationSummary& summary) {
    const std::vector<int> cuts = level_cuts(sequence.counted_left, levels);
    LevelBuilder builder(input, sequence, summary);
    std::vector<HierarchyLevel> result(levels);
    result.back() = builder.finest();
    for (int l = levels - 2; l >= 0; --l)
        result[l] = builder.next(cuts[l + 1], cuts[l], result[l + 1]);
    builder.locate_on_finest(result, cuts);
    builder.finish();
    for (int cut : cuts)
        summary.reached_vertices.push_back(sequence.counted_left[cut]);
    return result;
}

bool all_levels_alike(const std::vector<HierarchyLevel>& levels) {
    const auto counts = [](const HierarchyLevel& level) {
        return count_topology(static_cast<int>(level.rest.cols()), level.faces);
    };
    const TopologyCounts finest = counts(levels.back());
    return std::all_of(levels.begin(), levels.end(),
                       [&](const HierarchyLevel& level) { return counts(level).same_topology(finest); });
}

void report(const DecimationSummary& summary, Context* context) {
    if (context == nullptr)
        return;
    if (summary.ran_dry)
        context->on_message(fmt::format("decimation ended at {} vertices where {} were asked for: no further edge can "
                                        "be collapsed without harm",
                                        summary.reached_vertices.front(), summary.wanted_vertices.front()));
    if (!summary.topology_kept || summary.location_errors > 0)
        context->on_message(fmt::format("the hierarchy is faulty: topology {}, {} misplaced anchors",
                                        summary.topology_kept ? "kept" : "changed", summary.location_errors));
}

} // namespace

const char* rejection_name(Rejection rejection) {
    switch (rejection) {
    case Rejection::topology:
        return "topology";
    case Rejection::handle:
        return "handle";
    case Rejection::fold:
        return "fold";
    case Rejection::quality:
        return "quality";
    case Rejection::flattening:
        return "flattening";
    case Rejection::intersection:
        return "intersection";
    case Rejection::gap:
        return "gap";
    }
    return "";
}

Hierarchy decimate(const DecimationInput& input, const DecimationOptions& options, Context* context,
                   DecimationSummary* summary) {
    assert(options.levels >= 1 && static_cast<std::size_t>(input.rest.cols()) == input.part.size());
    const Stopwatch total;
    DecimationSummary found;
    CollapseSequence sequence;
    {
        EdgeCollapser collapser(input, options, found);
        sequence = collapser.run(context);
    }
    found.ran_dry = sequence.ran_dry;
    found.wanted_vertices = wanted_sizes(sequence.counted_left.front(), options);
    found.collapse_seconds = total.seconds();

    const Stopwatch map;
    Hierarchy hierarchy;
    hierarchy.levels = build_levels(input, sequence, options.levels, found);
    hierarchy.collapses = std::move(sequence.collapses);
    found.topology_kept = all_levels_alike(hierarchy.levels);
    found.map_seconds = map.seconds();
    found.total_seconds = total.seconds();
    report(found, context);
    if (summary != nullptr)
        *summary = std::move(found);
    return hierarchy;
}

} // namespace plisse
