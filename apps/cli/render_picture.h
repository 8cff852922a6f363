#pragma once

#include <optional>

#include <plisse/picture/draw.h>

#include "saved_run.h"

namespace plisse {

enum class Coloring { none, body, stretch, curvature, coarseness };

/// A mesh ready to be drawn: kept together because a picture refers to its parts.
struct Portrait {
    BodyMesh surface;
    int body_count = 0;
    std::optional<Scalars> scalars;

    Subject subject() const { return {surface.mesh.positions, surface.mesh.faces, surface.face_body, body_count}; }
};

/// A portrait of a mesh file that belongs to no run: none of its bodies is an obstacle. Throws InputError when it is to
/// be coloured by stretch, which needs the mesh at rest.
Portrait portrait_of_mesh(const std::filesystem::path& file, Coloring coloring);

/// A portrait of a frame. When the level's mesh at rest was not saved, stretch gives way to curvature, with a word on
/// standard error.
Portrait portrait_of_frame(const SavedRun& run, const SavedFrame& frame, Coloring coloring);

/// The pictures of a run on one sheet, all seen from the same place: the preview, each level, and the final state. The
/// options hold for each of them.
Image draw_sheet(const SavedRun& run, Coloring coloring, DrawOptions options);

} // namespace plisse
