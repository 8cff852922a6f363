#pragma once

#include <vector>

#include <plisse/base/types.h>

namespace plisse {

/// Triangles with their rest shapes: what becomes of each at given positions.
class RestTriangles {
public:
    /// rest: rest positions, m; faces: vertices in them, each of positive area.
    RestTriangles(const Positions& rest, std::vector<Face> faces);

    int count() const { return static_cast<int>(faces_.size()); }
    const Face& face(int f) const { return faces_[static_cast<std::size_t>(f)]; }
    /// Of the matrix of the rest triangle's edges, 1/m (triangle_frame.h).
    const Mat2& inverse(int f) const { return inverses_[static_cast<std::size_t>(f)]; }
    const std::vector<double>& areas() const { return areas_; } ///< m^2
    double area(int f) const { return areas_[static_cast<std::size_t>(f)]; }

    Mat32 deformation_gradient(int f, const Positions& x) const;
    /// The larger, then the smaller stretch of a face.
    Vec2 principal_stretches(int f, const Positions& x) const;
    /// Largest principal stretch over all faces; 0 without faces.
    double largest_stretch(const Positions& x) const;

    /// Writes the gradient over the nine unknowns of a face of a function of F, given its derivative times a factor.
    void pull_back_gradient(int f, const Mat32& derivative, double* gradient) const;

private:
    std::vector<Face> faces_;
    std::vector<Mat2> inverses_;
    std::vector<double> areas_;
};

} // namespace plisse
