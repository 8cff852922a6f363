#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <plisse/model/discretization.h>

namespace plisse::studio {

/// A hand on a body: some finest vertices near where it took hold, which it moves as one.
struct Hand {
    std::string id;
    std::string body;
    double stiffness = 0; ///< N/m of the spring at each vertex
    struct Point {
        int vertex;  ///< of the body's own mesh
        Vec3 offset; ///< m, from the vertex taken hold of
    };
    std::vector<Point> points;
    Vec3 to = Vec3::Zero(); ///< m

    /// An element of the scene's "pulls".
    nlohmann::ordered_json pull() const;
};

/// Takes hold of a vertex of a level (level: its number; of the finest mesh when that is what is shown). fine: present
/// positions of the finest vertices, 3 x n. Throws InputError for a vertex that is none of a body.
Hand take_hold(const Discretization& discretization, int level, int vertex, const Positions& fine, const Vec3& place);

} // namespace plisse::studio
