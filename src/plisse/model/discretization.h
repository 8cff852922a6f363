#pragma once

#include <cstdint>
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
    /// Decimates, unless the store has the result; says so through the context when a level cannot be as coarse as
    /// asked. level_count >= 1.
    Discretization(const Model& model, int level_count, Context& context, HierarchyStore* store = nullptr);

    const Model& model() const { return model_; }
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
    void lay_out(int level);
    Positions restricted_start(int level) const;

    Model model_;
    DecimationResult decimation_;
    std::vector<LevelLayout> layouts_;
    std::vector<std::vector<int>> handles_of_label_;
    std::vector<int> no_handles_;
};

} // namespace plisse
