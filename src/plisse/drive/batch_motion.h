#pragma once

#include <plisse/drive/expanding_mesh.h>

namespace plisse {

struct BatchMotionOptions {
    double reference_gap = 1e-3; ///< m: pairs approach to half of it, and nearer ones hardly (PSQ algorithm 4)
    double least_gap = 1e-6;     ///< m: nearer pairs afterwards are reported
    double margin = 1e-6;        ///< m: pairs that stay further apart than this may be left out
};

struct BatchMotionResult {
    int stopped_vertices = 0;       ///< held short of their targets
    double min_gap = 0;             ///< m, over the pairs looked at; infinity when there were none
    std::vector<int> tight_records; ///< of the batch: a vertex of theirs ended in a pair nearer than least_gap
};

/// Moves the split vertices of a batch toward their targets so that nothing ever meets: all advance by the largest safe
/// share, the pairs that limit it stop their vertices, and so on until the rest arrive (PSQ section 4.4.4, algorithm
/// 3). Records whose pairs have no vertices in common do not wait for each other. Same result for any thread count.
BatchMotionResult move_batch(ExpandingMesh& mesh, const std::vector<int>& records, const BatchMotionOptions& options);

} // namespace plisse
