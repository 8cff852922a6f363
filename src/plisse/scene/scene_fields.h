#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include <plisse/scene/json_cursor.h>
#include <plisse/scene/scene.h>

namespace plisse {

/// The keys of a scene file, each listed once: `describe(visitor, object)` names every key with the field it fills, its
/// limits and its meaning. Visitors are the reader, the writer and the schema; each offers
///   field(key, value, [limits,] doc)     a key that may be left out
///   required(key, value, [limits,] doc)  a key that may not
///   field_if(applies, key, value, limits, doc)   a key that other keys' values rule out
///   alternative(key, optional, doc)      one of several keys of which the object has one
///   check(holds, key, wrong, right)      what one key's type cannot say; only the reader minds
///   lists_what_is_there()                whether the object holds what is to be listed: true for the writer alone
///   version(key, doc)                    the format's version

/// The names of an enum's values in files, and the names that only later versions will take.
template <typename Enum>
struct Choices {
    struct Choice {
        std::string name;
        Enum value;
    };
    std::vector<Choice> choices;
    std::vector<std::string> later;
};

inline const Choices<GeneratorShape>& choices_of(GeneratorShape) {
    using S = GeneratorShape;
    static const Choices<S> all{{{"sheet", S::sheet},
                                 {"box", S::box},
                                 {"sphere", S::sphere},
                                 {"cylinder", S::cylinder},
                                 {"dome", S::dome},
                                 {"torus", S::torus},
                                 {"annulus", S::annulus},
                                 {"pumpkin", S::pumpkin},
                                 {"star", S::star}},
                                {}};
    return all;
}
inline const Choices<Pattern>& choices_of(Pattern) {
    using P = Pattern;
    static const Choices<Pattern> all{{{"irregular", P::irregular}, {"regular", P::regular}, {"quad", P::quad}}, {}};
    return all;
}
inline const Choices<Diagonals>& choices_of(Diagonals) {
    static const Choices<Diagonals> all{{{"alternating", Diagonals::alternating}, {"one", Diagonals::one}}, {}};
    return all;
}
inline const Choices<BendingModel>& choices_of(BendingModel) {
    static const Choices<BendingModel> all{{{"hinge", BendingModel::hinge}, {"koiter", BendingModel::koiter}}, {}};
    return all;
}
inline const Choices<MaterialLaw>& choices_of(MaterialLaw) {
    using L = MaterialLaw;
    static const Choices<MaterialLaw> all{
        {{"isotropic", L::isotropic}, {"denim-stable", L::denim_stable}, {"denim-table", L::denim_table}}, {}};
    return all;
}
inline const Choices<ProlongationOperator>& choices_of(ProlongationOperator) {
    using P = ProlongationOperator;
    static const Choices<P> all{{{"shell", P::shell},
                                 {"intrinsic", P::intrinsic},
                                 {"blend", P::blend},
                                 {"affine", P::affine},
                                 {"loop", P::loop}},
                                {}};
    return all;
}
inline const Choices<BendingOn>& choices_of(BendingOn) {
    static const Choices<BendingOn> all{{{"finest", BendingOn::finest}, {"level", BendingOn::level}}, {}};
    return all;
}
inline const Choices<HierarchySource>& choices_of(HierarchySource) {
    static const Choices<HierarchySource> all{
        {{"decimation", HierarchySource::decimation}, {"loop", HierarchySource::loop}}, {}};
    return all;
}
inline const Choices<Curvature>& choices_of(Curvature) {
    using C = Curvature;
    static const Choices<C> all{{{"auto", C::automatic}, {"own", C::own}, {"galerkin", C::galerkin}}, {}};
    return all;
}
inline const Choices<GradientKind>& choices_of(GradientKind) {
    static const Choices<GradientKind> all{{{"exact", GradientKind::exact}, {"lagged", GradientKind::lagged}}, {}};
    return all;
}
inline const Choices<SurfaceSolver>& choices_of(SurfaceSolver) {
    using S = SurfaceSolver;
    static const Choices<SurfaceSolver> all{{{"rmtr", S::rmtr},
                                             {"trust-region", S::trust_region},
                                             {"newton", S::newton},
                                             {"damped-newton", S::damped_newton},
                                             {"linearised", S::linearised}},
                                            {}};
    return all;
}
inline const Choices<SurfaceSmoother>& choices_of(SurfaceSmoother) {
    using S = SurfaceSmoother;
    static const Choices<SurfaceSmoother> all{{{"plain", S::plain},
                                               {"block-jacobi", S::block_jacobi},
                                               {"gauss-seidel", S::gauss_seidel},
                                               {"multigrid", S::multigrid}},
                                              {}};
    return all;
}
inline const Choices<SurfaceProjection>& choices_of(SurfaceProjection) {
    using P = SurfaceProjection;
    static const Choices<SurfaceProjection> all{
        {{"reverse-subdivision", P::reverse_subdivision}, {"least-squares", P::least_squares}}, {}};
    return all;
}
inline const Choices<SurfaceRadii>& choices_of(SurfaceRadii) {
    using R = SurfaceRadii;
    static const Choices<SurfaceRadii> all{{{"separate", R::separate}, {"single", R::single}}, {}};
    return all;
}
inline const Choices<Method>& choices_of(Method) {
    using M = Method;
    static const Choices<Method> all{{{"progressive", M::progressive}, {"direct", M::direct}, {"rmtr", M::rmtr}}, {}};
    return all;
}

template <typename Visitor>
void describe_sizes(Visitor& v, GeneratorOptions& g) {
    using S = GeneratorShape;
    const S shape = g.shape;
    if (shape == S::sheet) {
        Vec2 size(g.size.x(), g.size.y());
        v.field("size", size, positive, "m, along x and z");
        g.size = {size.x(), size.y(), g.size.z()};
    }
    if (shape == S::box)
        v.field("size", g.size, positive, "m, along x, y and z");
    if (shape != S::sheet && shape != S::box && shape != S::annulus)
        v.field("radius", g.radius, positive, "m; of a torus, of its ring");
    if (shape == S::cylinder || shape == S::pumpkin || shape == S::star)
        v.field("height", g.height, positive, "m, along y");
    if (shape == S::cylinder)
        v.field("caps", g.caps, "whether the ends are closed");
    if (shape == S::dome)
        v.field("angle_deg", g.angle_deg, Limits{1, 175}, "degrees from the apex to the rim");
    if (shape == S::torus) {
        v.field("tube", g.tube, positive, "m, radius of the tube");
        v.check(g.tube < g.radius, "tube", "the tube is as thick as its ring", "give a tube below radius");
    }
    if (shape == S::annulus) {
        v.field("inner", g.inner, positive, "m, inner radius");
        v.field("outer", g.outer, positive, "m, outer radius");
        v.check(g.inner < g.outer, "inner", "inner is not below outer", "give an inner radius below outer");
    }
    if (shape == S::pumpkin)
        v.field("lobes", g.lobes, Limits{3, 100}, "how many lobes");
    if (shape == S::star) {
        v.field("points", g.points, Limits{3, 1000}, "how many points");
        v.field("depth", g.depth, Limits{0.01, 0.9}, "how far the notches go in, as a share of radius");
        v.field("twist_deg", g.twist_deg, Limits{-179, 179}, "degrees that the top is turned against the bottom");
    }
}

template <typename Visitor>
void describe_cells(Visitor& v, GeneratorOptions& g) {
    const bool in_rows = g.pattern != Pattern::irregular;
    std::optional<std::array<int, 2>> cells;
    if (g.cells[0] > 0)
        cells = g.cells;
    v.field_if(in_rows, "cells", cells, Limits{1, 10000},
               "cells along x and z of a regular sheet; null takes them from edge_length");
    g.cells = cells.value_or(std::array<int, 2>{0, 0});
    v.field_if(g.pattern == Pattern::regular, "diagonals", g.diagonals, Limits{},
               "which way the cells of a regular sheet are cut");
}

template <typename Visitor>
void describe(Visitor& v, GeneratorOptions& g) {
    v.required("generate", g.shape, "the shape, centred at the origin, +y up");
    describe_sizes(v, g);
    v.field("edge_length", g.edge_length, positive, "m, of the triangles");
    v.field(
        "pattern", g.pattern,
        "irregular: a Delaunay-type mesh of relaxed points; regular: rows and columns; quad: a sheet's cells uncut, "
        "for the method rmtr");
    v.check(g.pattern != Pattern::quad || g.shape == GeneratorShape::sheet, "pattern", "only a sheet is made of quads",
            "give \"sheet\", or the quads of an OBJ file");
    v.field("seed", g.seed, "of the irregular pattern; the same seed gives the same mesh on every machine");
    if (g.shape == GeneratorShape::sheet)
        describe_cells(v, g);
}

template <typename Visitor>
void describe(Visitor& v, TransformSpec& t) {
    v.field("scale", t.scale, positive, "factor");
    v.field("rotate_deg", t.rotate_deg, "degrees about x, then y, then z");
    v.field("translate", t.translate, "m");
}

template <typename Visitor>
void describe(Visitor& v, Material& m) {
    v.field("density", m.density, positive, "kg/m^3 of solid");
    v.field("youngs_modulus", m.youngs_modulus, positive, "Pa");
    v.field("poisson_ratio", m.poisson_ratio, Limits{-0.95, 0.499}, "Poisson's ratio");
    v.field("thickness", m.thickness, positive, "m");
    v.field("bending", m.bending,
            "the bending energy: hinge is the papers', koiter converges to plate and shell theory on any mesh");
    v.field(
        "bending_scale", m.bending_scale, not_negative,
        "factor of the bending energy: 1 is exact for a sheet rolled along mesh lines, 3 compares with public codes");
    v.field(
        "law", m.law,
        "isotropic, or denim: orthotropic cloth for the method rmtr, where Young's modulus and Poisson's ratio mean "
        "nothing");
    v.field("strain_limit", m.strain_limit, Limits{1.0001, 100},
            "largest principal stretch, such as 1.1, which no triangle of any level passes; null: none");
}

template <typename Visitor>
void describe(Visitor& v, BodySpec& b) {
    v.field("name", b.name, "what other parts of the scene call the body; left out: body-0, body-1 ...");
    v.required("mesh", b.mesh, "the body's surface");
    v.field("transform", b.transform,
            "moves the body's mesh, rest mesh and start mesh alike: scale, rotate, translate");
    v.field("material", b.material, "a preset's name, or an object; what an object leaves out is as in cotton");
    v.field("pressure", b.pressure,
            "Pa; outward of a closed body whichever way its faces turn, along face normals of an open one; a number or "
            "keyframes [[t, Pa], ...]; {\"gas\": p0} and {\"volume\": ratio} are for a later version");
    v.field("rest", b.rest,
            "the shape free of stress: as-given, flat-angles (lengths as given, no rest curvature; where more than two "
            "faces meet angles as given), or {\"mesh\": ...} of the same connectivity");
    v.field("warp", b.warp,
            "by the method rmtr, the direction of an orthotropic cloth's warp where the body is at rest: one for all, "
            "or a list of one for each face of the mesh; on each face, its part along the face");
    v.check(std::all_of(b.warp.directions.begin(), b.warp.directions.end(), [](const Vec3& d) { return d.norm() > 0; }),
            "warp", "it has no direction", "give vectors that are not zero");
    v.field("start", b.start, "a mesh of the same connectivity to start from, when not the body's mesh");
}

template <typename Visitor>
void describe(Visitor& v, MotionKeySpec& k) {
    v.required("t", k.t, "s");
    v.field("translate", k.translate, "m, world coordinates; left out: the last value, at first 0");
    v.field("rotate_deg", k.rotate_deg, "degrees about x, y, z; left out: the last value, at first 0");
    v.field("about", k.about, "m, world coordinates; left out: the last value, at first the first one given");
}

template <typename Visitor, typename Selection>
void describe_selection(Visitor& v, SelectSpec& select, int& given, const char* key, const char* doc) {
    std::optional<Selection> selection;
    if (v.lists_what_is_there() && std::holds_alternative<Selection>(select))
        selection = std::get<Selection>(select);
    v.alternative(key, selection, doc);
    if (!selection)
        return;
    select = *selection;
    ++given;
}

template <typename Visitor>
void describe(Visitor& v, SelectSpec& select) {
    int given = 0;
    describe_selection<Visitor, BoxSelection>(v, select, given, "box",
                                              "[[x, y, z], [x, y, z]]: lowest and highest corner");
    describe_selection<Visitor, SphereSelection>(v, select, given, "sphere", "[[x, y, z], radius], m");
    describe_selection<Visitor, VertexSelection>(v, select, given, "vertices",
                                                 "numbers of vertices of the body's mesh");
    describe_selection<Visitor, LoopSelection>(
        v, select, given, "boundary_loop", "number of a boundary loop of the body, by order of their lowest vertex");
    v.check(given == 1, "", "a selection needs exactly one way to select",
            "give one of `box`, `sphere`, `vertices` and `boundary_loop`");
}

template <typename Visitor>
void describe(Visitor& v, ObstacleSpec& o) {
    v.field("name", o.name, "what other parts of the scene call the obstacle; left out: obstacle-0, obstacle-1 ...");
    v.required("mesh", o.mesh, "the obstacle's surface");
    v.field("transform", o.transform, "scale, rotate, translate");
    v.field("motion", o.motion, "keyframes; empty: fixed; deforming frames are for a later version");
    v.field("progressive", o.progressive, "whether it is decimated and refined with the hierarchy");
}

template <typename Visitor>
void describe(Visitor& v, HandleSpec& h) {
    v.field("name", h.name, "as the report calls it; left out: handle-0, handle-1 ...");
    v.required("body", h.body, "a body's name");
    v.field("axes", h.axes, "the prescribed axes: some of x, y and z");
    v.required("select", h.select, "the prescribed vertices");
    v.field("motion", h.motion, "keyframes; empty: held still");
}

template <typename Visitor>
void describe(Visitor& v, LoadSpec& l) {
    v.required("body", l.body, "a body's name");
    v.field("select", l.select, "the loaded vertices; null: the whole body");
    v.alternative("force", l.force, "N in all, shared out by area; a value or keyframes [[t, value], ...]");
    v.alternative("traction", l.traction, "Pa; a value or keyframes [[t, value], ...]");
    v.check(l.force.has_value() != l.traction.has_value(), "", "a load needs a force or a traction, and not both",
            "give one of `force` and `traction`");
}

template <typename Visitor>
void describe(Visitor& v, PullPointSpec& p) {
    v.required("vertex", p.vertex, not_negative, "number of a vertex of the body's mesh");
    v.required("to", p.to, "the place it is pulled to, m; a value or keyframes [[t, value], ...]");
}

template <typename Visitor>
void describe(Visitor& v, PullSpec& p) {
    v.field("name", p.name, "left out: pull-0, pull-1 ...");
    v.required("body", p.body, "a body's name");
    v.required("stiffness", p.stiffness, positive, "N/m, of the spring at each vertex");
    v.required("points", p.points, "the vertices that are pulled");
}

template <typename Visitor>
void describe(Visitor& v, ContactPairSpec& p) {
    v.required("a", p.a, "a body's or obstacle's name");
    v.required("b", p.b, "a body's or obstacle's name");
    v.field("friction", p.friction, not_negative, "Coulomb's coefficient of this pair");
}

template <typename Visitor>
void describe(Visitor& v, ContactSpec& c) {
    v.field("distance", c.distance, positive, "m; surfaces nearer than this repel");
    v.field("thickness", c.thickness, not_negative, "m; surfaces stay apart by more than this, like solid sheets");
    v.field("friction", c.friction, not_negative, "Coulomb's coefficient");
    v.field("friction_velocity", c.friction_velocity, positive, "m/s; below it, contacts stick");
    v.field("self", c.self, "whether a body meets itself");
    v.field("pairs", c.pairs, "friction of single pairs of bodies or obstacles");
}

template <typename Visitor>
void describe(Visitor& v, HierarchySettings& h) {
    v.field("source", h.source,
            "where the levels come from: decimation makes coarser ones from the user's mesh, loop makes finer ones by "
            "Loop's subdivision of bodies, boundaries fixed");
    const bool by_loop = h.source == HierarchySource::loop;
    if (by_loop && !v.lists_what_is_there())
        h.prolongation = ProlongationOperator::loop;
    v.field("levels", h.levels, Limits{1, 20},
            "how many meshes: 3 means levels 0, 1 and 2; the user's is the finest, by source loop level 0");
    v.field_if(!by_loop, "coarsest_vertices", h.coarsest_vertices, Limits{4, 1e9},
               "vertices of level 0 by decimation, over all bodies together; obstacles keep their own share");
    v.field("operator", h.prolongation, "the prolongation; left out, it is loop where the source is loop");
    v.check(by_loop || h.prolongation != ProlongationOperator::loop, "operator",
            "the operator loop needs levels made by subdivision",
            "set `source` to \"loop\", which makes the mesh the coarsest level, or take another operator");
    v.check(!by_loop || h.prolongation != ProlongationOperator::affine, "operator",
            "the operator affine needs levels made by decimation",
            "take loop, shell, blend or intrinsic, or set `source` to \"decimation\"");
    if (h.prolongation != ProlongationOperator::shell && !v.lists_what_is_there())
        h.bending_on = BendingOn::finest;
    v.field("bending_on", h.bending_on,
            "the mesh that carries the bending energy in previews; left out, it is finest with other operators than "
            "shell");
}

template <typename Visitor>
void describe(Visitor& v, RmtrSettings& r) {
    v.field("solver", r.solver,
            "what minimises a step: rmtr; on the finest level alone, to compare: trust-region, newton (line search), "
            "damped-newton, linearised");
    v.field("smoother", r.smoother, "on the levels of rmtr below the finest: preconditioner of conjugate gradients");
    v.field("finest_smoother", r.finest_smoother, "the same on the finest level");
    v.field("radii", r.radii, "of smoothing steps and coarse corrections: single is the paper's");
    v.field("projection", r.projection, "how a fine state is taken to the next coarser level");
    v.field("boundary_variables", r.boundary_variables,
            "whether unknowns beyond the boundary are replaced by points of the boundary curve");
    v.field("nested_iteration", r.nested_iteration, "whether coarser levels are solved first, for a start");
    v.field("penalty", r.penalty, positive,
            "N/m^3, of what holds a boundary; null: h^-5 in SI units, h being the finest level's mean side");
    v.field("thickness_points", r.thickness_points, Limits{3, 5}, "Gauss points over the thickness: 3 or 5");
    v.check(r.thickness_points != 4, "thickness_points", "there is no rule of 4 points", "give 3 or 5");
    v.field("max_cycles", r.max_cycles, Limits{1, 1e6}, "cycles, or iterations, after which a step gives up");
}

template <typename Visitor>
void describe(Visitor& v, SolveSettings& s) {
    v.field("method", s.method,
            "progressive: previews the timeline on level 0, then refines; direct: steps it on one mesh; rmtr: "
            "subdivision shells by recursive multilevel trust region");
    v.field("level", s.level, Limits{0, 19}, "direct on this level's own mesh; null: the finest");
    v.check(!s.level || s.method == Method::direct, "level", "a level is only for the method direct",
            "set `method` to \"direct\", or leave `level` out");
    v.field("time_step", s.time_step, positive, "s");
    v.field("duration", s.duration, not_negative, "s of the timeline");
    v.check(s.duration / s.time_step <= 1e7, "time_step", "the timeline has more than ten million steps",
            "give a longer time step or a shorter duration");
    v.field("settle", s.settle, "whether each level ends in equilibrium");
    v.field("max_settle_steps", s.max_settle_steps, Limits{0, 1e6}, "steps after which settling gives up");
    v.field("tolerance", s.tolerance, positive, "m/s; largest nodal Newton step per time step at equilibrium");
    v.field(
        "max_iterations_per_step", s.max_iterations_per_step, Limits{1, 1e6},
        "Newton iterations after which a step is cut short; null: 20 in previews, 1000 on the finest and in direct");
    v.field("frame_interval", s.frame_interval, positive, "s of the timeline between saved frames");
    v.field("curvature", s.curvature,
            "previews' Hessian: the level's own, the finest pulled back, or chosen by the scene");
    v.field("gradient", s.gradient, "previews' gradient: exact, or lagged as in PSQ equation 10");
    v.field("dynamics", s.dynamics, "implicit Euler steps with inertia instead of quasistatic ones");
    v.field_if(s.method == Method::rmtr, "rmtr", s.rmtr, Limits{}, "of the method rmtr");
}

template <typename Visitor>
void describe(Visitor& v, Scene& s) {
    v.version("plisse", "format version");
    v.field("name", s.name, "of the run; left out: the file's name");
    v.required("bodies", s.bodies, "the shells");
    v.field("obstacles", s.obstacles, "collision objects, fixed or scripted");
    v.field("handles", s.handles, "prescribed vertices");
    v.field("loads", s.loads, "dead loads on vertices");
    v.field("pulls", s.pulls, "springs that pull vertices of bodies to places, as a hand does");
    v.field("gravity", s.gravity, "m/s^2; a value or keyframes [[t, value], ...]");
    v.field("contact", s.contact, "contact between and within surfaces");
    v.field("hierarchy", s.hierarchy, "the levels");
    v.field("solve", s.solve, "the method and its settings");
    v.field("edits", s.edits,
            "the file of an edit log: changes of this scene at given steps, which a run makes as it goes; null: none");
}

} // namespace plisse
