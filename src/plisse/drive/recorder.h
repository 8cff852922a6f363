#pragma once

#include <array>
#include <string>
#include <vector>

#include <plisse/base/context.h>
#include <plisse/contact/friction.h>
#include <plisse/decimate/hierarchy.h>
#include <plisse/drive/coarseness.h>
#include <plisse/drive/preview_distance.h>
#include <plisse/solve/rmtr.h>

namespace plisse {

/// One saved state.
struct Frame {
    int level = 0;
    int number = 0;                       ///< of this level, from 0
    double t = 0;                         ///< s
    std::string phase;                    ///< preview | settle | refine | final
    const Positions* positions = nullptr; ///< of the level's vertices
};

/// One Newton iteration, for the log.
struct IterationRecord {
    int level = 0, step = 0, iteration = 0;
    double t = 0, energy = 0, step_norm = 0, gap = 0, seconds = 0, step_length = 0;
    StepLimit limit; ///< what has been cutting steps short; empty where it is not news
};

/// A change of the barrier's stiffness, made where a step ended with surfaces too near for it.
struct StiffeningRecord {
    int level = 0, step = 0;
    double t = 0;
    double gap_share = 0; ///< of the tightest pair: its gap over that at which it begins to repel
    double factor = 1;    ///< by which the barrier is stiffer from now on than at the start of the run
    double seconds = 0;
    std::string pair; ///< the tightest, in words, and where it is
};

struct EnergyParts {
    double elastic = 0, strain_limit = 0, contact = 0, friction = 0, gravity = 0, loads = 0; ///< J
};

/// What holds a handle or obstacle in its place.
struct Reaction {
    std::string name;
    Vec3 force = Vec3::Zero(), torque = Vec3::Zero(); ///< N and N m about the origin
};

/// What became of one level; the fields of report.json's "levels".
struct LevelReport {
    int level = 0, vertices = 0, faces = 0, steps = 0, newton_iterations = 0;
    bool equilibrium = false;
    double min_gap = 0;        ///< m; infinity where no pair is in contact range
    double max_stretch = 1;    ///< largest principal stretch of the level's own faces
    double residual = 0;       ///< largest nodal force of the total over the largest of any one term
    PreviewDistance to_final;  ///< of the level's last state, once there is a finest result
    TooCoarse too_coarse;      ///< for the shape of the bodies
    double estimated_turn = 0; ///< rad, from face to face: what was to be expected before the run
    EnergyParts energy;
    std::vector<Reaction> reactions; ///< of every handle and obstacle, at the level's last state
    std::vector<RmtrLevelWork> work; ///< of the method rmtr, on the coarsest level first; of others empty
    PhaseTimes seconds;
    double total_seconds = 0;
};

struct RefinementReport {
    int from = 0, to = 0, expansions = 0, colors = 0, first_try = 0, sampled = 0, relaxed = 0, deferred = 0;
    int stopped = 0;                 ///< vertices held short of their targets by what they would have met
    int over_limit = 0;              ///< faces that were at their strain limit or beyond, and were brought within it
    int strain_limit_iterations = 0; ///< of Newton's method, to bring them there
    double min_gap = 0;
    double total_seconds = 0;
};

/// A handle or obstacle that did not reach its scripted place.
struct Lag {
    std::string name;
    int vertices = 0;
    double distance = 0;                    ///< m, the largest
    std::vector<std::array<int, 2>> ranges; ///< first and last of each run of such vertices, ascending
};

enum class RunStatus { running, converged, not_converged, interrupted, failed };
const char* run_status_name(RunStatus status);

/// The whole of a run; the fields of report.json.
struct RunReport {
    std::string name, method, message;
    RunStatus status = RunStatus::running;
    double wall_seconds = 0;
    int intersecting_pairs = 0;
    std::vector<LevelReport> levels;
    std::vector<RefinementReport> refinements;
    std::vector<Reaction> reactions; ///< those of the finest level
    std::vector<Lag> lagging;
};

/// Everything needed to go on with a run after the last completed step. A refinement counts as one step.
struct Checkpoint {
    int level = 0;
    int step = 0;                    ///< steps of the timeline done
    int settle_step = 0;             ///< settling steps done on this level
    double settle_time_step = 0;     ///< s, of the next settling step
    double settle_tolerance = 0;     ///< m/s, of the next settling step
    double stiffness_factor = 1;     ///< of the barrier
    bool stiffening_helps = true;    ///< whether a stiffer barrier has widened the smallest gaps of this level so far
    bool settled = false;            ///< this level is done
    double t = 0;                    ///< s
    Positions positions;             ///< of the level's vertices, exact
    Positions velocity;              ///< m/s, of the same vertices, in the last step of the timeline; empty before it
    FrictionMemory friction;         ///< of the level's contacts
    std::vector<Positions> previews; ///< the last states of the levels before, from the coarsest
    std::vector<int> frame_numbers;  ///< next frame number per level
    RunReport report;
};

/// Receives what a run produces, as it produces it. The drivers write nothing themselves.
class Recorder {
public:
    virtual ~Recorder() = default;
    virtual void on_hierarchy(const Hierarchy&) {}
    virtual void on_iteration(const IterationRecord&) {}
    virtual void on_stiffening(const StiffeningRecord&) {}
    virtual void on_frame(const Frame&) {}
    /// After every completed step, and at the end.
    virtual void on_checkpoint(const Checkpoint&) {}
    virtual void on_report(const RunReport&) {}
};

} // namespace plisse
