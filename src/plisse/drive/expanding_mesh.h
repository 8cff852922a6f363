#pragma once

#include <cstdint>
#include <vector>

#include <plisse/decimate/dynamic_faces.h>
#include <plisse/model/discretization.h>
#include <plisse/spatial/hash_grid.h>

namespace plisse {

/// A deformed mesh on its way from one level to the next finer one. Everything is by hierarchy id; faces and boxes are
/// those of the moment.
class ExpandingMesh {
public:
    /// x: positions of level `from`, intersection-free. t: time of the scripts.
    ExpandingMesh(const Discretization& discretization, int from, const Positions& x, double t);

    const Discretization& discretization() const { return discretization_; }
    const DynamicFaces& faces() const { return faces_; }
    const Positions& rest() const { return rest_; }
    const Positions& targets() const {
        return targets_;
    } ///< where each vertex of the next level (and of between) should go
    Vec3 position(int id) const { return positions_.col(id); }
    const Positions& positions() const { return positions_; }
    Positions& positions() { return positions_; }
    void set_position(int id, const Vec3& p) { positions_.col(id) = p; }
    bool is_obstacle_vertex(int id) const { return obstacle_[static_cast<std::size_t>(id)] != 0; }
    bool is_obstacle_face(int face) const { return is_obstacle_vertex(faces_.face(face)[0]); }

    /// Undoes a collapse at one point: i and j appear where k was.
    void split(const Collapse& collapse);
    /// Takes a split back; k comes to lie where i is.
    void merge(const Collapse& collapse);
    /// Takes new boxes of faces, grown over what their vertices may yet do; `reach` gives a vertex's box.
    template <typename Reach>
    void update_boxes(const std::vector<int>& faces, const Reach& reach) {
        for (int f : faces) {
            Box box;
            for (int v : faces_.face(f))
                box.include(reach(v));
            if (grid_.contains(f))
                grid_.update(f, box);
            else
                grid_.insert(f, box);
        }
    }
    const HashGrid& grid() const { return grid_; }

    /// Positions of the next level's vertices, once every batch is done.
    Positions level_positions(int level) const;

private:
    void set_targets(int from, const Positions& next_level);

    const Discretization& discretization_;
    DynamicFaces faces_;
    Positions positions_, rest_, targets_;
    std::vector<std::uint8_t> obstacle_;
    HashGrid grid_;
};

} // namespace plisse
