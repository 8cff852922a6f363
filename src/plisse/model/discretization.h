#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <plisse/base/context.h>
#include <plisse/decimate/hierarchy_store.h>
#include <plisse/model/model.h>

namespace plisse {

/// What a run needs to know of one level beside its mesh.
struct LevelLayout {
    std::vector<int> face_part;      ///< per face: body, or obstacle after the bodies
    std::vector<Face> body_faces;    ///< the faces of bodies, with level vertices
    std::vector<int> body_face_part; ///< per body face
    std::vector<int> source;         ///< per vertex: the finest vertex it coincides with at rest, when pinned; else -1
    std::vector<std::uint8_t> prescribed; ///< per unknown (3 per vertex)
    std::vector<int> script_of; ///< per unknown: the handle, or obstacle after the handles, that prescribes it
};

/// A model on its hierarchy: levels, scripts and start states. Level 0 is the coarsest.
class Discretization {
public:
    /// Decimates, unless the store has the result, and says so through the context when a level cannot be as coarse as
    /// asked; or subdivides. level_count >= 1. Throws InputError when a level made by subdivision intersects itself.
    Discretization(const Model& model, int level_count, Context& context, HierarchyStore* store = nullptr);

    /// On the finest level. By subdivision a vertex between others belongs to a handle or a load when all of those do,
    /// and attributes are left out.
    const Model& model() const { return model_; }
    /// Puts another model in its place that differs in nothing but parameters: materials, pressures, motions that are
    /// the same at t = 0, values of loads, pulls, gravity, contact and the solver's settings. Problems and steppers
    /// made before must not be used any more.
    void set_model(Model model) { model_ = std::move(model); }
    /// Of a subdivided mesh the hierarchy and its counts.
    const DecimationResult& decimation() const { return decimation_; }
    const Hierarchy& hierarchy() const { return decimation_.hierarchy; }
    const HierarchyLevel& mesh(int level) const { return hierarchy().levels[static_cast<std::size_t>(level)]; }
    const LevelLayout& layout(int level) const { return layouts_[static_cast<std::size_t>(level)]; }
    int finest() const { return hierarchy().level_count() - 1; }

    /// Where the script wants the prescribed unknowns of a level at time t (other entries are the rest positions).
    Positions script(int level, double t) const;

    /// Positions to start from on a level: bodies as the model starts, obstacles where their script has them at t = 0.
    /// Throws InputError when a start shape that differs from rest cannot be carried to the level without
    /// intersections.
    Positions start(int level) const;

    /// A body's handles on a vertex of a level, as indices into model().handles.
    const std::vector<int>& handles_of(int level, int vertex) const;

private:
    void subdivide_model(int level_count);
    void expect_no_intersections() const;
    std::function<bool(int, int)> both_obstacles(int level) const;
    void lay_out(int level);
    Positions restricted_start(int level) const;
    Positions subdivided_start(int level) const;

    Model model_;
    Positions start_on_input_; ///< by subdivision: of level 0
    DecimationResult decimation_;
    std::vector<LevelLayout> layouts_;
    std::vector<std::vector<int>> handles_of_label_;
    std::vector<int> no_handles_;
};

} // namespace plisse
