#include <plisse/model/fold_estimate.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Geometry>

#include <plisse/energy/dihedral_terms.h>
#include <plisse/energy/hinge.h>
#include <plisse/mesh/connectivity.h>
#include <plisse/spatial/box.h>

namespace plisse {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
/// Root mean square over a sheet of the curvature across its edges, over the largest: sqrt(3/8) over directions,
/// sqrt(1/2) over a sine.
constexpr double mean_share = 0.43;
/// A rest shape's turn harms less than that of a fold, since prolongation is exact at rest: edges of 0.3 radii have
/// been seen to do.
constexpr double shape_share = 0.5;
/// Strain times R / t at which a thin shell buckles: half of the classical 0.6, as real ones do. Of pressure on a
/// sphere over E (t / R)^2, half.
constexpr double shell_buckling = 0.3;
constexpr int samples = 64; ///< of the timeline

std::size_t at(int index) {
    return static_cast<std::size_t>(index);
}

/// The largest slope of folds that take up this strain.
double fold_slope(double strain) {
    return std::min(1.0, 2 * std::sqrt(strain));
}

FoldScale fold_of_wavelength(FoldCause cause, double wavelength, double slope) {
    return {cause, wavelength / (2 * std::numbers::pi * slope * mean_share), wavelength};
}

FoldScale fold_of_ridges(FoldCause cause, double radius, double slope) {
    return {cause, radius / (slope * mean_share), radius};
}

FoldScale scale_of_shape(double radius) {
    return {FoldCause::shape, radius / shape_share, radius};
}

double face_area(const Face& face, const Positions& x) {
    return Vec3(x.col(face[1]) - x.col(face[0])).cross(Vec3(x.col(face[2]) - x.col(face[0]))).norm() / 2;
}

/// A body and what its folds depend on.
struct Shell {
    const Model& model;
    int number;
    const Body& body;
    double rigidity, stiffness; ///< D, E t
    double size, radius;        ///< m

    bool curved() const { return radius < size; }
    /// Strain at which a flat one of this span gives way sideways.
    double buckling_strain(double span) const {
        return 4 * std::pow(std::numbers::pi / span, 2) * rigidity / stiffness;
    }
};

Shell shell_of(const Model& model, int number) {
    const Body& body = model.bodies[at(number)];
    const Material& m = body.material;
    const std::span<const Face> faces =
        std::span(model.mesh.faces).subspan(at(body.faces.begin), at(body.faces.size()));
    double area = 0;
    for (const Face& face : faces)
        area += face_area(face, model.mesh.positions);
    return {model,
            number,
            body,
            m.bending_scale * bending_rigidity(m.youngs_modulus, m.poisson_ratio, m.thickness),
            m.youngs_modulus * m.thickness,
            std::sqrt(area),
            curvature_radius(model.mesh.positions, faces)};
}

template <typename Value>
double largest_norm(const Track<Value>& track) {
    double largest = 0;
    for (const auto& key : track.keys)
        largest = std::max(largest, key.value.norm());
    return largest;
}

void add_weight_folds(const Shell& shell, std::vector<FoldScale>& scales) {
    const Material& m = shell.body.material;
    const double weight = m.density * m.thickness * largest_norm(shell.model.gravity);
    if (!(weight > 0))
        return;
    if (shell.curved() && weight * shell.radius < shell_buckling * shell.stiffness * m.thickness / shell.radius)
        return; // it bears its weight by its curvature
    FoldScale folds =
        fold_of_wavelength(FoldCause::weight, wrinkle_length(shell.rigidity, weight * shell.size, shell.size), 1);
    // As a cantilever, one that is stiff for its size bends little.
    folds.radius =
        std::max(folds.radius, 2 * std::pow(bending_length(shell.rigidity, weight), 3) / (shell.size * shell.size));
    scales.push_back(folds);
}

/// The most that two handles of one body do to what is between them.
struct HandleStrain {
    double span = 0;     ///< m
    double approach = 0; ///< share of the span by which they come nearer
    double shear = 0;    ///< principal strain of stretch or shear
};

Vec3 mean_position(const Handle& handle, const Positions& rest) {
    return rest(Eigen::all, handle.vertices).rowwise().mean();
}

/// Of b, seen from a.
HandleStrain strain_between(const Handle& a, const Handle& b, const Model& model) {
    const Positions& rest = model.mesh.positions;
    const Vec3 way = mean_position(b, rest) - mean_position(a, rest);
    HandleStrain strain;
    strain.span = way.norm();
    if (!(strain.span > 0))
        return strain;
    for (int k = 0; k <= samples; ++k) {
        const double t = model.solve.duration * k / samples;
        for (int v : b.vertices) {
            const Vec3 moved = (a.motion.undo(b.motion.apply(rest.col(v), t), t) - rest.col(v)) / strain.span;
            const double along = moved.dot(way) / strain.span;
            const double across = (moved - along * way / strain.span).norm();
            strain.approach = std::max(strain.approach, -along);
            strain.shear = std::max({strain.shear, along, std::min(1.0, across) / 2});
        }
    }
    strain.approach = std::min(strain.approach, 1.0);
    strain.shear = std::min(strain.shear, 1.0);
    return strain;
}

std::vector<HandleStrain> handle_strains(const Shell& shell) {
    std::vector<HandleStrain> strains;
    const auto& handles = shell.model.handles;
    for (std::size_t i = 0; i < handles.size(); ++i)
        for (std::size_t j = i + 1; j < handles.size(); ++j)
            if (handles[i].body == shell.number && handles[j].body == shell.number)
                strains.push_back(strain_between(handles[i], handles[j], shell.model));
    return strains;
}

void add_handle_folds(const Shell& shell, const HandleStrain& strain, std::vector<FoldScale>& scales) {
    const double least = shell.buckling_strain(strain.span);
    if (strain.approach > least)
        scales.push_back(fold_of_wavelength(FoldCause::approach, strain.span, fold_slope(strain.approach)));
    if (strain.shear > least)
        scales.push_back(fold_of_wavelength(FoldCause::shear,
                                            wrinkle_length(shell.rigidity, shell.stiffness * strain.shear, strain.span),
                                            fold_slope(strain.shear)));
}

/// The farthest that an obstacle goes, by the corners of its box, m.
double travel(const Obstacle& obstacle, const Model& model) {
    const Range& vertices = obstacle.vertices;
    const Box box = bounding_box(model.mesh.positions.middleCols(vertices.begin, vertices.size()));
    double farthest = 0;
    for (int k = 1; k <= samples; ++k)
        for (int corner = 0; corner < 8; ++corner) {
            Vec3 point = box.low;
            for (int axis = 0; axis < 3; ++axis)
                if (corner >> axis & 1)
                    point[axis] = box.high[axis];
            const Vec3 moved = obstacle.motion.apply(point, model.solve.duration * k / samples);
            farthest = std::max(farthest, (moved - obstacle.motion.apply(point, 0)).norm());
        }
    return farthest;
}

void add_crush_folds(const Shell& shell, const std::vector<HandleStrain>& strains, std::vector<FoldScale>& scales) {
    const Material& m = shell.body.material;
    const double slenderness = m.thickness / shell.radius;
    const double pressure = shell.body.pressure.at(shell.model.solve.duration);
    const double ridges = ridge_radius(m.thickness, shell.radius);
    if (-pressure > 2 * shell_buckling * m.youngs_modulus * slenderness * slenderness)
        scales.push_back(fold_of_ridges(FoldCause::suction, ridges, 1));
    if (pressure > shell_buckling * m.youngs_modulus * slenderness * slenderness)
        return; // inflated, it is always in tension
    double strain = 0;
    for (const HandleStrain& s : strains)
        strain = std::max({strain, s.approach, s.shear});
    for (const Obstacle& obstacle : shell.model.obstacles)
        strain = std::max(strain, std::min(1.0, travel(obstacle, shell.model) / shell.size));
    if (strain > shell_buckling * slenderness)
        scales.push_back(fold_of_ridges(FoldCause::crush, ridges, fold_slope(strain)));
}

/// Lengths of the edges of one part, ascending.
std::vector<double> edge_lengths(const HierarchyLevel& level, int part) {
    const Connectivity mesh(static_cast<int>(level.rest.cols()), level.faces);
    std::vector<double> lengths;
    for (const Edge& edge : mesh.edges())
        if (level.part[at(edge[0])] == part)
            lengths.push_back((level.rest.col(edge[1]) - level.rest.col(edge[0])).norm());
    std::sort(lengths.begin(), lengths.end());
    return lengths;
}

/// The least that a share of them does not exceed.
double quantile(const std::vector<double>& ascending, double share) {
    return ascending.empty() ? 0
                             : ascending[static_cast<std::size_t>(share * static_cast<double>(ascending.size() - 1))];
}

} // namespace

std::string describe(FoldCause cause) {
    switch (cause) {
    case FoldCause::shape:
        return "the curvature at rest";
    case FoldCause::weight:
        return "folds under its weight";
    case FoldCause::approach:
        return "the buckle between handles";
    case FoldCause::shear:
        return "wrinkles between handles";
    case FoldCause::crush:
        return "ridges of a crushed shell";
    case FoldCause::suction:
        return "ridges under inward pressure";
    }
    return "";
}

double bending_length(double rigidity, double weight) {
    return std::cbrt(rigidity / weight);
}

double wrinkle_length(double rigidity, double tension, double span) {
    return 2 * std::sqrt(std::numbers::pi * span) * std::pow(rigidity / tension, 0.25);
}

double ridge_radius(double thickness, double curvature_radius) {
    return std::cbrt(curvature_radius * curvature_radius * thickness);
}

double curvature_radius(const Positions& rest, std::span<const Face> faces) {
    const Connectivity mesh(static_cast<int>(rest.cols()), faces);
    // Around a vertex angle times length, half of it its own, is the sum of both curvatures times area. Edge by edge
    // the signs of irregular meshes would count.
    VecX turns = VecX::Zero(rest.cols());
    for (const std::array<int, 4>& v : interior_hinges(mesh, faces).vertices) {
        const double turn = dihedral_angle_at(v, rest) * (rest.col(v[1]) - rest.col(v[0])).norm() / 2;
        turns[v[0]] += turn;
        turns[v[1]] += turn;
    }
    double area = 0;
    for (const Face& face : faces)
        area += face_area(face, rest);
    const double turn = turns.cwiseAbs().sum();
    return turn > 1e-9 * std::sqrt(area) ? 2 * area / turn : infinity;
}

FoldScale shape_scale(const Positions& rest, std::span<const Face> faces) {
    return scale_of_shape(curvature_radius(rest, faces));
}

std::vector<FoldScale> fold_scales(const Model& model, int body) {
    const Shell shell = shell_of(model, body);
    std::vector<FoldScale> scales{scale_of_shape(shell.radius)};
    add_weight_folds(shell, scales);
    const std::vector<HandleStrain> strains = handle_strains(shell);
    if (shell.curved())
        add_crush_folds(shell, strains, scales);
    else
        for (const HandleStrain& strain : strains)
            add_handle_folds(shell, strain, scales);
    std::stable_sort(scales.begin(), scales.end(),
                     [](const FoldScale& a, const FoldScale& b) { return a.radius < b.radius; });
    return scales;
}

std::vector<FoldScale> governing_scales(const Model& model) {
    std::vector<FoldScale> scales;
    for (int body = 0; body < static_cast<int>(model.bodies.size()); ++body)
        scales.push_back(fold_scales(model, body).front());
    return scales;
}

const char* verdict_name(Verdict verdict) {
    switch (verdict) {
    case Verdict::sound:
        return "sound";
    case Verdict::marginal:
        return "marginal";
    case Verdict::too_coarse:
        return "too coarse";
    }
    return "";
}

Verdict verdict_on(double turn) {
    return turn <= most_turn / 2 ? Verdict::sound : turn <= most_turn ? Verdict::marginal : Verdict::too_coarse;
}

LevelEstimate estimate_level(const HierarchyLevel& level, std::span<const FoldScale> scales) {
    LevelEstimate estimate;
    std::vector<double> all;
    for (int part = 0; part < static_cast<int>(scales.size()); ++part) {
        const std::vector<double> lengths = edge_lengths(level, part);
        const double turn = quantile(lengths, 0.5) / scales[at(part)].radius;
        if (part == 0 || turn > estimate.turn)
            estimate.part = part, estimate.turn = turn;
        all.insert(all.end(), lengths.begin(), lengths.end());
    }
    std::sort(all.begin(), all.end());
    estimate.median_edge = quantile(all, 0.5);
    estimate.long_edge = quantile(all, 0.95);
    estimate.governing = scales[at(estimate.part)];
    estimate.verdict = verdict_on(estimate.turn);
    return estimate;
}

int enough_vertices(const HierarchyLevel& finest, std::span<const FoldScale> scales) {
    constexpr double least = 4; // vertices of a body
    // Of equilateral triangles of edge 1 a vertex has sqrt(3)/2; decimated meshes have longer edges for their vertices.
    constexpr double vertices_an_area = 1.15 * 2 / std::numbers::sqrt3;
    std::vector<double> areas(scales.size(), 0.0);
    for (const Face& face : finest.faces)
        if (const std::size_t part = at(finest.part[at(face[0])]); part < areas.size())
            areas[part] += face_area(face, finest.rest);
    double sum = 0;
    for (std::size_t part = 0; part < scales.size(); ++part) {
        const double edge = most_turn * scales[part].radius;
        const auto has =
            static_cast<double>(std::count(finest.part.begin(), finest.part.end(), static_cast<int>(part)));
        sum += std::min(has, std::max(least, std::ceil(vertices_an_area * areas[part] / (edge * edge))));
    }
    return static_cast<int>(sum);
}

} // namespace plisse
