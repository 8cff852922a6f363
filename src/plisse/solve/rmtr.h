#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include <plisse/solve/trust_region.h>

namespace plisse {

/// Between a level and the next finer one.
class LevelTransfer {
public:
    virtual ~LevelTransfer() = default;
    /// S, fine x coarse, for corrections; its transpose restricts gradients.
    virtual const ScalarTransfer& prolongation() const = 0;
    /// P: the coarse point of a fine one, with P S = I.
    virtual VecX project(const VecX& fine) const = 0;
};

/// Both as sparse tables.
class SparseTransfer : public LevelTransfer {
public:
    SparseTransfer(ScalarTransfer prolongation, ScalarTransfer projection)
        : prolongation_(std::move(prolongation)), projection_(std::move(projection)) {}
    const ScalarTransfer& prolongation() const override { return prolongation_; }
    VecX project(const VecX& fine) const override { return prolonged(projection_, fine); }

private:
    ScalarTransfer prolongation_, projection_;
};

/// Of conjugate gradients preconditioned by diagonal blocks, which smooth where plain ones do not.
inline QuadraticOptions smoothing_by_block_jacobi() {
    QuadraticOptions options;
    options.method = QuadraticMethod::conjugate_gradients;
    options.preconditioning = Preconditioning::block_jacobi;
    return options;
}
/// For the finest level alone: truncated Newton steps, by conjugate gradients (see `project`). The preconditioner, a
/// V-cycle for a positive semi-definite approximation of H, is also the norm of the radius.
inline QuadraticOptions newton_by_multigrid() {
    QuadraticOptions options;
    options.method = QuadraticMethod::conjugate_gradients;
    options.preconditioning = Preconditioning::multigrid;
    options.norm = RadiusNorm::preconditioner;
    options.project = true;
    options.max_iterations = 100;
    options.tolerance = 1e-2;
    return options;
}
inline QuadraticOptions coarsest_by_dogleg() {
    QuadraticOptions options;
    options.method = QuadraticMethod::dogleg;
    return options;
}

struct RmtrOptions {
    TrustRegionConstants constants;
    TrustRegionStop stop;  ///< max_iterations counts cycles, changes are those of a cycle
    double radius = 1;     ///< the first, on the finest level
    double epsilon = 1e-3; ///< a level is left when its iterate is beyond (1 - epsilon) of the radius above
    int pre_steps = 1, post_steps = 1;
    QuadraticOptions smoother = smoothing_by_block_jacobi(); ///< on the levels between
    QuadraticOptions finest = smoothing_by_block_jacobi();   ///< multigrid: Newton's method by preconditioned CG there
    QuadraticOptions coarsest = coarsest_by_dogleg();        ///< of a single level too, unless `finest` is by multigrid
    /// Times that a rejected step is tried again at once with its smaller radius, for which nothing is assembled. The
    /// paper's 0 wastes the visit to a level whose first radius is too large.
    int retries = 4;
    /// Begins a visit to a coarse level with no more than gamma2 times the radius it was left with; the paper begins
    /// with the radius above whatever happened before.
    bool remember_radii = true;
    /// Smoothing steps and coarse corrections each have a radius. With the paper's single one, corrections that are
    /// rejected shorten the smoothing steps too, and the other way round.
    bool separate_radii = true;
    /// A level's corrections rest for 1, 3, 7 ... visits after each further rejection in a row, at most so many; 0 for
    /// the paper's, which never rest.
    int longest_rest = 31;
    /// No correction where the restricted gradient |S'g| is below this share of |g| (Gratton, Sartenaer and Toint
    /// 2008); 0 for the paper's.
    double least_restricted = 0.1;
    int nested_cycles = 0; ///< > 0: the start is first improved on each coarser level in turn by so many cycles
};

/// What one level did, in a cycle or in all.
struct RmtrLevelWork {
    int visits = 0;
    int accepted = 0, rejected = 0;                         ///< smoothing steps
    int corrections_accepted = 0, corrections_rejected = 0; ///< from the next coarser level
    int assemblies = 0, quadratic_solves = 0, quadratic_iterations = 0, evaluations = 0;
    double quadratic_products = 0; ///< what the quadratic solves cost, in products with H (see QuadraticStep)
    double largest_correction = 0; ///< of those from the coarser level, as a share of the radius
    RmtrLevelWork& operator+=(const RmtrLevelWork& other);
};

/// Work units of (7.3), from the coarsest level's work to the finest's: the sum over levels of 4^-(L - l) times the
/// assemblies of H there, or the quadratic problems solved there, whatever solving one took.
double assembly_units(std::span<const RmtrLevelWork> levels);
double quadratic_units(std::span<const RmtrLevelWork> levels);
/// The same of what quadratic problems took: ten products with H are a unit, as they are in the paper, whose every
/// solve has that many.
double product_units(std::span<const RmtrLevelWork> levels);

struct RmtrCycle {
    int cycle = 0;
    int finest_level = 0; ///< of this cycle: below the last one in nested iteration
    double value = 0, gradient_norm = 0, radius = 0;
    std::vector<RmtrLevelWork> levels;
};

struct RmtrSummary {
    TrustRegionEnd end = TrustRegionEnd::gradient;
    std::string message; ///< why it ended, in words
    double value = 0, gradient_norm = 0, radius = 0;
    int cycles = 0;                    ///< on the finest level
    int nested_cycles = 0;             ///< on all coarser ones before
    std::vector<RmtrLevelWork> levels; ///< in all
    bool converged() const { return is_converged(end); }
};

/// Recursive multilevel trust region (Kopanicakova, Krause and Tamstorf 2019, algorithms 4.1-4.3) from x on the finest
/// level, where f never rises by more than rounding. levels: coarsest first; transfers[l] is between l and l + 1; with
/// one level the method is algorithm 4.1. A coarse level minimises f_l + <dg, x - x0>, within radii measured by |v|_l =
/// |S ... S v| on the finest level; prolonged corrections are cut by max_step like any step. Nested iteration takes a
/// coarse level's way to be a safe one of the finest: max_step must guard the same on all levels. Where the finest
/// quadratic solver is multigrid, all levels' unknowns must be free. on_accepted is called for the finest level.
RmtrSummary minimize_by_rmtr(std::span<Objective* const> levels, std::span<const LevelTransfer* const> transfers,
                             VecX& x, const RmtrOptions& options, Context& context,
                             const std::function<void(const RmtrCycle&)>& observe = {});

} // namespace plisse
