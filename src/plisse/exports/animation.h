#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include <plisse/mesh/triangle_mesh.h>

namespace plisse {

/// States of one mesh through time, for writers that read them in turn: wherever they are kept, one is in memory at a
/// time.
struct Animation {
    std::string name;
    std::vector<std::string> parts; ///< names of bodies and obstacles
    std::vector<int> face_part;     ///< of every face: its index in parts
    std::vector<double> times;      ///< s, ascending; at least one

    /// State number k < times.size(). Faces and the names and domains of attributes are the same in all states. It may
    /// be asked for more than once, and what it throws passes through the writer, which then leaves nothing behind.
    std::function<TriangleMesh(std::size_t k)> state;

    std::size_t size() const { return times.size(); }
};

} // namespace plisse
