#include "render_picture.h"

#include <algorithm>
#include <limits>

#include <fmt/core.h>

#include <plisse/base/error.h>
#include <plisse/picture/contact_sheet.h>

namespace plisse {

namespace {

/// Curvatures peak at single vertices; leave this share of them off the scale.
constexpr double curvature_cut = 0.01;
constexpr double stretch_cut = 0.001;

Scalars curvature_scalars(const BodyMesh& surface, const Subject& subject) {
    Scalars scalars{"curvature 1/m", MeshAttribute::Domain::vertex,
                    mean_curvatures(surface.mesh.positions, surface.mesh.faces), 0, 1};
    std::vector<bool> of_body(scalars.values.size(), false);
    for (std::size_t f = 0; f < surface.mesh.faces.size(); ++f)
        for (int v : surface.mesh.faces[f])
            of_body[static_cast<std::size_t>(v)] = !subject.is_obstacle(f);
    fit_range(scalars, of_body, curvature_cut);
    scalars.low = 0;
    return scalars;
}

Scalars stretch_scalars(const BodyMesh& surface, const Subject& subject, const TriangleMesh& rest) {
    Scalars scalars{"stretch", MeshAttribute::Domain::face,
                    largest_stretches(rest.positions, surface.mesh.positions, surface.mesh.faces), 0, 1};
    std::vector<bool> of_body(scalars.values.size());
    for (std::size_t f = 0; f < of_body.size(); ++f)
        of_body[f] = !subject.is_obstacle(f);
    fit_range(scalars, of_body, stretch_cut);
    return scalars;
}

/// As saved with the frame. The range is the same for all pictures, with 1 in its middle.
Scalars coarseness_scalars(const BodyMesh& surface, const std::filesystem::path& file) {
    for (const MeshAttribute& attribute : surface.mesh.attributes)
        if (attribute.name == "coarseness" && attribute.domain == MeshAttribute::Domain::vertex && attribute.width == 1)
            return {"coarseness, 1: limit", MeshAttribute::Domain::vertex, attribute.values, 0, 2};
    throw InputError(file.string(), "it has no vertex property \"coarseness\"",
                     "give what a run of this version has saved, or another --color");
}

/// The mesh at rest that belongs to a frame, where the run has saved it.
std::optional<TriangleMesh> rest_of(const SavedRun& run, const SavedFrame& frame, const TriangleMesh& mesh) {
    const std::filesystem::path file = run.rest_file(frame.level);
    if (!std::filesystem::exists(file)) {
        fmt::print(stderr, "plisse: note: {} is missing, so stretch is not known; coloured by curvature instead\n",
                   file.string());
        return std::nullopt;
    }
    TriangleMesh rest = read_body_mesh(file).mesh;
    if (rest.faces != mesh.faces || rest.vertex_count() != mesh.vertex_count())
        throw InputError(file.string(), "it is not the rest mesh of " + frame.file.string(), "run the scene again");
    return rest;
}

/// Vertices of bodies, without those of obstacles.
int count_body_vertices(const Subject& subject) {
    std::vector<bool> of_body(static_cast<std::size_t>(subject.positions.cols()), false);
    for (std::size_t f = 0; f < subject.faces.size(); ++f)
        for (int v : subject.faces[f])
            if (!subject.is_obstacle(f))
                of_body[static_cast<std::size_t>(v)] = true;
    return static_cast<int>(std::count(of_body.begin(), of_body.end(), true));
}

std::string describe(const SavedFrame& frame, const Subject& subject) {
    return fmt::format("{} vertices, {}, t = {:.4g} s", count_body_vertices(subject), frame.phase, frame.t);
}

struct SheetEntry {
    std::string title;
    SavedFrame frame;
};

std::vector<SheetEntry> sheet_entries(const SavedRun& run) {
    std::vector<SheetEntry> entries;
    const SavedFrame* const preview = run.last_frame(-1, -1, "preview");
    if (preview)
        entries.push_back({fmt::format("preview on level {}", preview->level), *preview});
    for (int level = 0; level <= run.finest_level(); ++level) {
        const SavedFrame* const last = run.last_frame(level, -1, "");
        if (last && last != preview && !(last->phase == "final" && run.final_state))
            entries.push_back({fmt::format("level {}", level), *last});
    }
    if (run.final_state)
        entries.push_back({fmt::format("final, on level {}", run.final_state->level), *run.final_state});
    return entries;
}

/// One range of values for all pictures, so that a colour means the same on each.
void share_range(std::vector<Portrait>& portraits) {
    std::optional<double> low, high;
    for (const Portrait& portrait : portraits)
        if (portrait.scalars) {
            low = std::min(low.value_or(portrait.scalars->low), portrait.scalars->low);
            high = std::max(high.value_or(portrait.scalars->high), portrait.scalars->high);
        }
    for (Portrait& portrait : portraits)
        if (portrait.scalars) {
            portrait.scalars->low = *low;
            portrait.scalars->high = *high;
        }
}

double diagonal(const Positions& points) {
    return points.cols() == 0 ? 0 : (points.rowwise().maxCoeff() - points.rowwise().minCoeff()).norm();
}

/// Points that frame all pictures alike, so that they can be compared; empty when some body has moved so far that the
/// others would hardly be seen.
Positions common_frame(const std::vector<Portrait>& portraits) {
    constexpr double farthest = 3; // times the smallest picture's own size
    Positions all(3, 0);
    double smallest = std::numeric_limits<double>::infinity();
    for (const Portrait& portrait : portraits) {
        const Positions points = framing_points(portrait.subject());
        smallest = std::min(smallest, diagonal(points));
        Positions joined(3, all.cols() + points.cols());
        joined << all, points;
        all.swap(joined);
    }
    return diagonal(all) <= farthest * smallest ? all : Positions(3, 0);
}

} // namespace

Portrait portrait_of_mesh(const std::filesystem::path& file, Coloring coloring) {
    if (coloring == Coloring::stretch)
        throw InputError(file.string(), "a mesh alone has no stretch",
                         "give the output folder of a run, or another --color");
    Portrait portrait{read_body_mesh(file), 1, std::nullopt};
    for (int body : portrait.surface.face_body)
        portrait.body_count = std::max(portrait.body_count, body + 1);
    if (coloring == Coloring::curvature)
        portrait.scalars = curvature_scalars(portrait.surface, portrait.subject());
    if (coloring == Coloring::coarseness)
        portrait.scalars = coarseness_scalars(portrait.surface, file);
    return portrait;
}

Portrait portrait_of_frame(const SavedRun& run, const SavedFrame& frame, Coloring coloring) {
    Portrait portrait{read_body_mesh(frame.file), run.body_count, std::nullopt};
    std::optional<TriangleMesh> rest;
    if (coloring == Coloring::stretch)
        rest = rest_of(run, frame, portrait.surface.mesh);
    if (rest)
        portrait.scalars = stretch_scalars(portrait.surface, portrait.subject(), *rest);
    else if (coloring == Coloring::stretch || coloring == Coloring::curvature)
        portrait.scalars = curvature_scalars(portrait.surface, portrait.subject());
    else if (coloring == Coloring::coarseness)
        portrait.scalars = coarseness_scalars(portrait.surface, frame.file);
    return portrait;
}

Image draw_sheet(const SavedRun& run, Coloring coloring, DrawOptions options) {
    const std::vector<SheetEntry> entries = sheet_entries(run);
    if (entries.empty())
        throw InputError(run.folder.string(), "the run has saved nothing yet", "wait, or run the scene again");
    std::vector<Portrait> portraits;
    for (const SheetEntry& entry : entries)
        portraits.push_back(portrait_of_frame(run, entry.frame, coloring));
    share_range(portraits);
    const Positions frame = common_frame(portraits);
    options.frame = frame.cols() > 0 ? &frame : nullptr;
    options.tell_bodies_apart = coloring != Coloring::none;

    std::vector<Panel> panels;
    for (std::size_t i = 0; i < entries.size(); ++i) {
        options.scalars = portraits[i].scalars ? &*portraits[i].scalars : nullptr;
        panels.push_back({draw(portraits[i].subject(), options), entries[i].title,
                          describe(entries[i].frame, portraits[i].subject())});
    }
    return contact_sheet(panels, run.name);
}

} // namespace plisse
