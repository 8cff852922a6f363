#pragma once

#include <map>

#include <plisse/drive/staged_run.h>

#include "board.h"
#include "commands.h"

namespace plisse::studio {

/// Makes what pages draw from the state of a run: each mesh once, positions for every way of looking at them.
class Projector {
public:
    /// Meshes shown from now on may be those of another run.
    void begin_run() { meshes_.clear(); }

    /// The state of the run; the finest mesh by prolongation alone where `show` asks for it.
    Board::Picture picture(StagedRun& run, const Show& show);
    /// A saved state of one of its levels at time t.
    Board::Picture saved(const Discretization& discretization, int level, double t, const Positions& x);
    /// A mesh that cannot be used, the faces where that shows marked.
    Board::Picture unusable(const TriangleMesh& mesh, const std::vector<int>& marked);

private:
    struct Mesh {
        std::uint32_t version;
        std::shared_ptr<const Bytes> message;
        std::vector<double> levels; ///< per vertex: the coarsest level that has it
    };
    const Mesh& mesh(const Discretization& discretization, int level);

    std::map<int, Mesh> meshes_; ///< by level
    std::uint32_t last_version_ = 0;
};

} // namespace plisse::studio
