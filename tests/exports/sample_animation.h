#pragma once

#include <cmath>
#include <numbers>

#include <plisse/exports/animation.h>

namespace plisse {

/// A waving strip of cloth with a seam in its texture, a triangle that hops, and a floor that lies still. The last time
/// is off the beat; one vertex is of no face.
inline Animation sample_animation() {
    constexpr int columns = 4;
    TriangleMesh rest;
    rest.positions.resize(3, 2 * columns + 3 + 4 + 1);
    for (int c = 0; c < columns; ++c)
        for (int side = 0; side < 2; ++side)
            rest.positions.col(2 * c + side) = Vec3(0.1 * c, 0.5, 0.1 * side);
    rest.positions.rightCols(8) << 0.5, 0.6, 0.5, -1, 1, 1, -1, 7, //
        0.2, 0.2, 0.2, 0, 0, 0, 0, 7,                              //
        0.0, 0.0, 0.1, -1, -1, 1, 1, 7;
    for (int c = 0; c + 1 < columns; ++c) {
        rest.faces.push_back({2 * c, 2 * c + 1, 2 * c + 2});
        rest.faces.push_back({2 * c + 2, 2 * c + 1, 2 * c + 3});
    }
    rest.faces.insert(rest.faces.end(), {{8, 10, 9}, {11, 13, 12}, {11, 14, 13}});

    using Domain = MeshAttribute::Domain;
    MeshAttribute uv{"uv", Domain::corner, 2, {}};
    for (std::size_t f = 0; f < rest.faces.size(); ++f)
        for (int v : rest.faces[f]) {
            const double second_half = f == 4 || f == 5 ? 0.5 : 0.0; // a piece of its own on the texture
            uv.values.insert(uv.values.end(), {rest.positions(0, v) + second_half, rest.positions(2, v)});
        }
    rest.attributes.push_back(uv);
    rest.attributes.push_back({"coarseness", Domain::vertex, 1, {}});
    rest.attributes.push_back({"panel", Domain::face, 1, {0, 0, 1, 1, 2, 2, 3, 4, 4}, MeshAttribute::Number::int32});
    for (const char* name : {"red", "green", "blue"})
        rest.attributes.push_back({name, Domain::vertex, 1, std::vector<double>(16, 51), MeshAttribute::Number::uint8});

    Animation animation;
    animation.name = "two things & a floor";
    animation.parts = {"cloth", "1st \"wild\" part", "floor"};
    animation.face_part = {0, 0, 0, 0, 0, 0, 1, 2, 2};
    animation.times = {0, 0.1, 0.2, 0.30000000000000004, 0.45};
    animation.state = [rest, times = animation.times](std::size_t k) {
        TriangleMesh state = rest;
        const double t = times.at(k);
        for (int v = 0; v < 8; ++v)
            state.positions(1, v) += 0.1 * std::sin(2 * std::numbers::pi * (t + 3 * rest.positions(0, v)));
        for (int v = 8; v < 11; ++v)
            state.positions(1, v) += t;
        for (int v = 0; v < state.vertex_count(); ++v)
            state.attributes[1].values.push_back(t + v);
        return state;
    };
    return animation;
}

} // namespace plisse
