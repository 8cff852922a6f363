#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include <plisse/mesh/triangle_mesh.h>
#include <plisse/model/rmtr_settings.h>
#include <plisse/model/track.h>
#include <plisse/transfer/prolongation_operator.h>

namespace plisse {

enum class BendingModel {
    hinge, ///< HingeEnergy: the papers'
    koiter ///< KoiterBending: converges to plate and shell theory
};

/// How a material answers strain.
enum class MaterialLaw {
    isotropic,   ///< by Young's modulus and Poisson's ratio
    denim_table, ///< orthotropic woven cloth as printed (RMTR table 1), for the method rmtr
    denim_stable ///< the same with a coupling of warp and weft that keeps its energy from falling below 0
};

/// A shell material.
struct Material {
    double density = 472.6;       ///< kg/m^3 of solid, > 0
    double youngs_modulus = 8e5;  ///< Pa, > 0
    double poisson_ratio = 0.243; ///< in (-1, 0.5)
    double thickness = 3e-4;      ///< m, > 0
    double bending_scale = 1;     ///< c of DESIGN.md section 4, >= 0
    /// Largest principal stretch, > 1; empty: none.
    std::optional<double> strain_limit = std::nullopt;
    BendingModel bending = BendingModel::hinge;
    MaterialLaw law = MaterialLaw::isotropic; ///< the others know no Young's modulus and no Poisson's ratio
};

/// Half-open range of vertices or faces of the model's mesh.
struct Range {
    int begin = 0, end = 0;
    int size() const { return end - begin; }
    bool contains(int i) const { return begin <= i && i < end; }
};

struct Body {
    std::string name;
    Range vertices, faces;
    Material material;
    Track<double> pressure{0.0}; ///< Pa; outward of a closed body whichever way its faces turn, else along face normals
    bool flat_rest_angles = false; ///< lengths as given, no rest curvature
};

struct Obstacle {
    std::string name;
    Range vertices, faces;
    MotionTrack motion;
    bool progressive = true; ///< decimated and refined with the hierarchy
};

/// Vertices of one body whose positions are prescribed in some axes.
struct Handle {
    std::string name;
    int body = 0;
    std::vector<int> vertices; ///< of the model's mesh, ascending
    std::array<bool, 3> axes{true, true, true};
    MotionTrack motion;
};

/// A dead load on some vertices of a body.
struct Load {
    enum class Kind { force, traction }; ///< N in all, shared out by area | Pa per rest area
    Kind kind = Kind::force;
    int body = 0;
    std::vector<int> vertices; ///< of the model's mesh, ascending
    Track<Vec3> value{Vec3::Zero()};
};

/// Springs of rest length 0 from vertices of a body to places in space, as a hand pulls at cloth.
struct Pull {
    struct Point {
        int vertex = 0; ///< of the model's mesh
        Track<Vec3> to{Vec3::Zero()};
    };
    std::string name;
    int body = 0;
    double stiffness = 0; ///< N/m of each spring, > 0
    std::vector<Point> points;
};

struct ContactSettings {
    /// Coulomb's coefficient between two parts, or within one.
    struct Pair {
        int a = 0, b = 0; ///< bodies, or obstacles after the bodies
        double friction = 0;
    };
    double distance = 1e-3; ///< m, > 0
    double thickness = 0;   ///< m, >= 0: surfaces stay apart by more than this
    bool self = true;
    double friction = 0;             ///< Coulomb's coefficient of pairs not listed, >= 0
    double friction_velocity = 1e-3; ///< m/s, > 0: contacts that slide more slowly stick
    std::vector<Pair> pairs;
};

/// Coulomb's coefficients of all pairs of parts, row by row.
std::vector<double> friction_coefficients(const ContactSettings& contact, int part_count);

enum class HierarchySource {
    decimation, ///< the model's mesh is the finest level, the others come of it by edge collapse
    loop        ///< the model's mesh is the coarsest level, the others come of it by Loop's subdivision of bodies
};
enum class BendingOn { finest, level };
enum class Curvature { automatic, own, galerkin };
enum class GradientKind { exact, lagged };
enum class Method { progressive, direct, rmtr };

struct HierarchySettings {
    int levels = 3;                                                  ///< meshes, >= 1
    int coarsest_vertices = 500;                                     ///< by decimation
    ProlongationOperator prolongation = ProlongationOperator::shell; ///< affine: by decimation; loop: by loop
    BendingOn bending_on = BendingOn::level; ///< made for shell; the other operators bend well on the finest
    HierarchySource source = HierarchySource::decimation;
};

struct SolveSettings {
    Method method = Method::progressive;
    std::optional<int> level; ///< `direct` on this level's own mesh; the finest when empty
    double time_step = 0.1;   ///< s, > 0
    double duration = 0;      ///< s, >= 0
    bool settle = true;
    int max_settle_steps = 200;
    double tolerance = 1e-3; ///< m/s
    /// Newton iterations after which a step is cut short. Empty: 20 on preview levels, 1000 on the finest and in
    /// direct.
    std::optional<int> max_iterations_per_step;
    double frame_interval = 0.1; ///< s of the timeline, > 0
    Curvature curvature = Curvature::automatic;
    GradientKind gradient = GradientKind::exact;
    bool dynamics = false;
    RmtrSettings rmtr;
};

/// Everything a run needs: all bodies, then all obstacles, in one mesh, with loads, scripts and settings.
struct Model {
    std::string name;
    TriangleMesh mesh; ///< rest positions of bodies, positions at t = 0 of obstacles (before their motion)
    Positions start;   ///< positions to start from; equals mesh.positions where nothing else was asked for
    std::vector<Body> bodies;
    std::vector<Obstacle> obstacles;
    std::vector<Handle> handles;
    std::vector<Load> loads;
    std::vector<Pull> pulls;
    Track<Vec3> gravity{Vec3(0, -9.81, 0)}; ///< m/s^2
    ContactSettings contact;
    HierarchySettings hierarchy;
    SolveSettings solve;

    /// Number of the body or obstacle (after the bodies) of each vertex.
    std::vector<int> vertex_parts() const;
    std::vector<int> face_parts() const;
    const std::string& part_name(int part) const;
    int part_count() const { return static_cast<int>(bodies.size() + obstacles.size()); }
    bool is_obstacle(int part) const { return part >= static_cast<int>(bodies.size()); }
};

} // namespace plisse
