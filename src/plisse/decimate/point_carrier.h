#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <plisse/decimate/dynamic_faces.h>
#include <plisse/decimate/joint_flattening.h>

namespace plisse {

/// The triangles of a chart before and after its collapse, by face id. Those of sheets that rest are left out.
struct ChartTriangles {
    struct Triangle {
        int face, sheet;
        std::array<Vec2, 3> corner;     ///< in the order of the face's corners
        std::array<bool, 3> on_curve{}; ///< whether the side opposite each corner is on a curve
    };
    std::vector<Triangle> before, after;
    std::array<bool, 2> ends_on_curve{}; ///< whether i and j are
    bool merged_on_curve = false;        ///< whether k is

    /// Fills both from a collapse that `faces` have not made yet. on_curve: by vertex id. Keeps its memory.
    void lay_out(const Collapse& collapse, const Chart& chart, const DynamicFaces& faces,
                 const std::vector<bool>& on_curve);

private:
    Patch patch_; // scratch
};

/// Follows points of a surface through collapses: each is a vertex until that is collapsed away, then a point of a face
/// (the charts of Liu et al. 2021 make the map one to one). Collapses that are undone take points the other way. Points
/// of curves stay on them, all others in their sheet.
class PointCarrier {
public:
    /// One point at each of these vertices.
    PointCarrier(std::span<const int> vertices, int vertex_id_count, int face_id_count);

    /// Moves the points of the collapsing patch.
    void carry(const Collapse& collapse, const Chart& chart, const ChartTriangles& triangles);
    /// The same where the collapse is undone.
    void carry_back(const Collapse& collapse, const Chart& chart, const ChartTriangles& triangles);

    /// Where a point is, by face id. A point at a vertex takes the lowest face around it, one on an edge where sheets
    /// are joined the lowest face on that.
    Anchor anchor(int point, const DynamicFaces& faces) const;

    long relocations() const { return relocations_; }
    /// Points that no new triangle holds within round-off, and the smallest weight met.
    int errors() const { return errors_; }
    double worst() const { return worst_; }

private:
    struct Moving {
        static constexpr int any_sheet = -1;
        int point;
        Vec2 place;
        bool on_curve;
        int sheet;
    };

    void move_vertex_point(int vertex, int heir, const Vec2& place, bool on_curve);
    void relocate(const std::vector<ChartTriangles::Triangle>& from, const std::vector<ChartTriangles::Triangle>& to);
    void lift(const ChartTriangles::Triangle& triangle);
    void settle(const Moving& moving, const std::vector<ChartTriangles::Triangle>& triangles);

    std::vector<int> point_at_vertex_; ///< by vertex id, -1: none
    std::vector<int> first_in_face_;   ///< by face id, -1: none
    std::vector<int> next_in_face_;    ///< by point
    std::vector<Anchor> places_;       ///< by point; face -1 while at a vertex
    std::vector<int> vertices_;        ///< by point; -1 while in a face
    std::vector<Moving> moving_;
    long relocations_ = 0;
    int errors_ = 0;
    double worst_ = 0;
};

} // namespace plisse
