#pragma once

#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <plisse/mesh/generate.h>
#include <plisse/model/model.h>
#include <plisse/scene/json_document.h>

namespace plisse {

/// A scene file as written, defaults filled in. Field by field it mirrors the file; scene_fields.h lists names, limits
/// and meanings once for the reader, the writer and the schema.

/// A mesh file, relative to the scene file, or a generator.
struct MeshSpec {
    std::string file; ///< empty: generate
    GeneratorOptions generator;
    bool is_file() const { return !file.empty(); }
};

/// Scale, then rotation about x, y, z, then translation.
struct TransformSpec {
    double scale = 1;
    Vec3 rotate_deg = Vec3::Zero();
    Vec3 translate = Vec3::Zero(); ///< m
};

/// The shape in which a body is free of stress.
struct RestSpec {
    enum class Kind { as_given, flat_angles, mesh };
    Kind kind = Kind::as_given;
    MeshSpec mesh; ///< of the same connectivity, for Kind::mesh
};

/// Where the warp of an orthotropic cloth runs, after the transform.
struct WarpSpec {
    std::vector<Vec3> directions{Vec3::UnitX()}; ///< one for all faces, or one a face
};

struct BodySpec {
    std::string name;
    MeshSpec mesh;
    TransformSpec transform; ///< of the mesh, of the rest mesh and of the start mesh alike
    Material material;
    Track<double> pressure{0.0};
    RestSpec rest;
    std::optional<MeshSpec> start;
    WarpSpec warp;
};

/// A key of a scripted motion; a field left out keeps its last value.
struct MotionKeySpec {
    double t = 0; ///< s
    std::optional<Vec3> translate, rotate_deg, about;
};
using MotionSpec = std::vector<MotionKeySpec>;

struct ObstacleSpec {
    std::string name;
    MeshSpec mesh;
    TransformSpec transform;
    MotionSpec motion;
    bool progressive = true;
};

struct BoxSelection {
    Vec3 low = Vec3::Zero(), high = Vec3::Zero(); ///< m, a closed set
};
struct SphereSelection {
    Vec3 center = Vec3::Zero();
    double radius = 0; ///< m
};
struct VertexSelection {
    std::vector<int> vertices; ///< of the body's own mesh
};
struct LoopSelection {
    int loop = 0; ///< number of a boundary loop of the body
};
using SelectSpec = std::variant<BoxSelection, SphereSelection, VertexSelection, LoopSelection>;

struct HandleSpec {
    std::string name, body;
    std::array<bool, 3> axes{true, true, true};
    SelectSpec select;
    MotionSpec motion;
};

/// Exactly one of force and traction is given.
struct LoadSpec {
    std::string body;
    std::optional<SelectSpec> select; ///< the whole body when empty
    std::optional<Track<Vec3>> force, traction;
};

/// A vertex and where it is pulled to.
struct PullPointSpec {
    int vertex = 0; ///< of the body's own mesh
    Track<Vec3> to{Vec3::Zero()};
};

struct PullSpec {
    std::string name, body;
    double stiffness = 0; ///< N/m of each spring
    std::vector<PullPointSpec> points;
};

/// A pair of bodies or obstacles with contact settings of its own.
struct ContactPairSpec {
    std::string a, b;
    double friction = 0; ///< Coulomb's coefficient
};

struct ContactSpec {
    double distance = ContactSettings{}.distance;
    double thickness = ContactSettings{}.thickness;                 ///< m
    double friction = ContactSettings{}.friction;                   ///< Coulomb's coefficient of pairs not listed
    double friction_velocity = ContactSettings{}.friction_velocity; ///< m/s
    bool self = true;
    std::vector<ContactPairSpec> pairs;
};

struct Scene {
    std::string name;
    std::vector<BodySpec> bodies;
    std::vector<ObstacleSpec> obstacles;
    std::vector<HandleSpec> handles;
    std::vector<LoadSpec> loads;
    std::vector<PullSpec> pulls;
    Track<Vec3> gravity{Vec3(0, -9.81, 0)}; ///< m/s^2
    ContactSpec contact;
    HierarchySettings hierarchy;
    SolveSettings solve;
    std::optional<std::string> edits; ///< the file of an edit log, relative to the scene file

    std::filesystem::path folder;                 ///< where relative mesh files are looked for
    std::shared_ptr<const JsonDocument> document; ///< for the places in messages; null for a scene made in memory

    /// An error about the value that this JSON pointer names.
    InputError error_at(const std::string& pointer, const std::string& what_is_wrong,
                        const std::string& what_would_be_right) const;
    /// The same from an error that knows of no scene (with an empty place).
    InputError error_at(const std::string& pointer, const InputError& without_place) const;
};

} // namespace plisse
