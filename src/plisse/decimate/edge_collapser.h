#pragma once

#include <optional>
#include <vector>

#include <plisse/decimate/clearance.h>
#include <plisse/decimate/collapse_queue.h>
#include <plisse/decimate/decimate.h>
#include <plisse/decimate/joint_flattening.h>
#include <plisse/decimate/placement.h>

namespace plisse {

/// What a decimation leaves behind: all collapses with their charts, and what each vertex id is.
struct CollapseSequence {
    std::vector<Collapse> collapses;
    std::vector<Chart> charts;         ///< per collapse
    Positions rest;                    ///< by vertex id
    std::vector<VertexState> vertices; ///< by id
    std::vector<int> counted_left;     ///< counted vertices before the first collapse and after each
    bool ran_dry = false;
};

/// Collapses edges, the cheapest first, until the counted vertices are as few as asked for or no edge can go.
class EdgeCollapser {
public:
    EdgeCollapser(const DecimationInput& input, const DecimationOptions& options, DecimationSummary& summary);

    CollapseSequence run(const Context* context);

private:
    struct Group {
        int initial = 0, left = 0;
        bool dry = false;
        double share() const { return static_cast<double>(left) / initial; }
    };

    void count_groups();
    void fill_queue(std::span<const Face> faces);
    int next_group() const;
    void add_edge(const Edge& edge, bool is_curve_edge);
    void try_edge(int number);
    std::optional<Rejection> attempt(Edge edge);
    bool topology_allows() const;
    bool handle_allows(Alias alias) const;
    std::optional<Rejection> judge_shapes();
    void commit(Alias alias);
    void record();
    void merge_vertices(Alias alias);
    void update_queue();

    const DecimationOptions options_;
    DecimationSummary& summary_;
    DynamicFaces faces_;
    CollapseSequence made_;
    std::vector<FaceShape> shapes_; ///< by face id
    std::vector<bool> obstacle_parts_;
    std::vector<Group> groups_;
    std::vector<int> label_counts_;
    Placer placer_;
    CollapseQueue queue_;
    std::optional<Clearance> clearance_;

    JointFlattening flattening_; // scratch from here on
    Patch patch_;
    Chart chart_;
};

} // namespace plisse
