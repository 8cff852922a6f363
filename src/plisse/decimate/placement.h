#pragma once

#include <optional>
#include <vector>

#include <plisse/decimate/decimate.h>
#include <plisse/decimate/joint_flattening.h>
#include <plisse/decimate/quadric.h>
#include <plisse/decimate/vertex_state.h>

namespace plisse {

/// Where the merged vertex goes, and what that costs.
struct Placement {
    Vec3 position;
    Alias alias = Alias::none; ///< it takes exactly the position of this end
    double cost = 0;
};

/// Places merged vertices by quadrics. Each vertex has one with probabilistic face planes, which decides costs and
/// inner positions, and one with exact face planes for vertices on curves, which the first would pull off them. Both
/// hold planes through curve edges, across each sheet that ends there.
class Placer {
public:
    /// Quadrics of vertices 0, 1, ... from the faces among them that are to be decimated.
    Placer(const Positions& rest, std::span<const Face> faces, const std::vector<VertexState>& vertices,
           const DecimationOptions& options);

    /// Nothing when the edge may never collapse: a pinned end would have to move, or a curve to leave itself.
    std::optional<Placement> place(const Edge& edge, bool is_curve_edge, const Positions& rest,
                                   const std::vector<VertexState>& vertices) const;

    /// Adds the next vertex, which merges an edge.
    void merge(const Edge& edge);

private:
    struct VertexQuadrics {
        Quadric cost, exact;
    };

    void scale_to(const Positions& rest, std::span<const Face> faces, const std::vector<VertexState>& vertices);
    void add_faces(const Positions& rest, std::span<const Face> faces, const std::vector<VertexState>& vertices);
    void add_curves(const Positions& rest, std::span<const Face> faces, const std::vector<VertexState>& vertices);
    Alias kept_end(const Edge& edge, const Positions& rest, const VertexState& i, const VertexState& j) const;
    Vec3 curve_minimiser(const Edge& edge, const Positions& rest) const;
    double jitter(const Edge& edge) const;

    /// Quadrics are kept in coordinates of about unit size.
    Vec3 inward(const Vec3& x) const { return (x - center_) * scale_; }
    Vec3 outward(const Vec3& x) const { return center_ + x / scale_; }

    const DecimationOptions options_;
    Vec3 center_ = Vec3::Zero();
    double scale_ = 1;     ///< a power of two, so that scaling is exact
    double mean_edge_ = 1; ///< scaled
    std::vector<VertexQuadrics> quadrics_;
};

} // namespace plisse
