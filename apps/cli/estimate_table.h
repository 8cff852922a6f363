#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include <plisse/model/fold_estimate.h>

namespace plisse {

/// What is estimated of a hierarchy before any run: how a level's edges compare with the folds its bodies may make.
struct FoldEstimates {
    std::vector<std::string> names;             ///< of the bodies
    std::vector<std::vector<FoldScale>> scales; ///< of each, the governing one first
    std::vector<LevelEstimate> levels;
    int enough_vertices = 0; ///< what coarsest_vertices should at least be
    int body_vertices = 0;   ///< on the finest level
};

/// The bodies are the hierarchy's first parts.
FoldEstimates estimate_folds(const Hierarchy& hierarchy, std::vector<std::string> names,
                             std::vector<std::vector<FoldScale>> scales);

/// Lines for a terminal.
std::string estimate_table(const FoldEstimates& estimates);

/// Adds to each of json["levels"] its edges and verdict, and "estimate" to json.
void add_estimates(const FoldEstimates& estimates, nlohmann::ordered_json& json);

} // namespace plisse
