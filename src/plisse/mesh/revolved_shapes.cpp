#include <plisse/mesh/shapes.h>

#include <algorithm>
#include <cassert>

#include <plisse/mesh/portable_math.h>

namespace plisse {

namespace {

/// A circle about the y axis, or the point on it where the radius is 0. Rings run from the top down the outside.
struct Ring {
    enum class Hold { none, some, all };
    double radius = 0;
    double y = 0;
    int count = 1;
    int patch = 0; ///< of the strip between the ring before and this one, and of the ring's free vertices
    Hold hold = Hold::none;
    int held_count = 4;     ///< vertices that `some` holds, evenly spread; divides count
    bool staggered = false; ///< begins half a step further round
};

using Deformation = std::function<Vec3(const Vec3&)>;

std::vector<int> add_ring(PatchMesh& mesh, const Ring& ring, const Deformation& deform) {
    std::vector<int> chain;
    for (int i = 0; i < ring.count; ++i) {
        const CosSin turn = cos_sin_turns((i + (ring.staggered ? 0.5 : 0.0)) / ring.count);
        const Vec3 p(ring.radius * turn.cos, ring.y, -ring.radius * turn.sin);
        const bool held =
            ring.hold == Ring::Hold::all || (ring.hold == Ring::Hold::some && i % (ring.count / ring.held_count) == 0);
        chain.push_back(mesh.add_vertex(deform(p), held ? PatchMesh::fixed : ring.patch));
    }
    if (ring.count > 1)
        chain.push_back(chain.front());
    return chain;
}

PatchMesh zip_rings(
    const std::vector<Ring>& rings, bool closed, const Deformation& deform = [](const Vec3& p) { return p; }) {
    PatchMesh mesh;
    std::vector<std::vector<int>> chains;
    for (const Ring& ring : rings)
        chains.push_back(add_ring(mesh, ring, deform));
    for (std::size_t k = 1; k < rings.size(); ++k)
        mesh.zip(chains[k], chains[k - 1], rings[k].patch);
    if (closed)
        mesh.zip(chains.front(), chains.back(), rings.front().patch);
    return mesh;
}

/// Steps between the vertices of free rings, and between rings. What will be refined begins twice as wide.
struct Steps {
    explicit Steps(const GeneratorOptions& options)
        : edge(options.edge_length), along(options.pattern == Pattern::regular ? edge : 2 * edge),
          across(options.pattern == Pattern::regular ? row_height * edge : 2 * edge) {}
    double edge, along, across;
};

/// Vertices of a border or of a ring with held quarters: a multiple of four.
int quartered(double radius, double step) {
    return 4 * divisions(2 * pi * radius, 4 * step, 2);
}

Ring free_ring(double radius, double y, const Steps& steps, int patch) {
    return {radius, y, divisions(2 * pi * radius, steps.along, 4), patch};
}

Ring held_ring(double radius, double y, int count, int patch, Ring::Hold hold) {
    return {radius, y, count, patch, hold};
}

Ring point_ring(double y, int patch, Ring::Hold hold) {
    return {0, y, 1, patch, hold};
}

/// Rings of a sphere about the origin after the polar angle `from`, up to `to` and in steps of at most about `across`;
/// the last is `last`. Angles in turns.
void add_sphere_rings(std::vector<Ring>& rings, double radius, double from, double to, const Steps& steps,
                      const Ring& last) {
    const int count = divisions(2 * pi * radius * (to - from), steps.across);
    for (int k = 1; k < count; ++k) {
        const CosSin polar = cos_sin_turns(from + (to - from) * k / count);
        rings.push_back(free_ring(radius * polar.sin, radius * polar.cos, steps, last.patch));
    }
    rings.push_back(last);
}

Shape sphere(const GeneratorOptions& options) {
    const double radius = options.radius;
    const Steps steps(options);
    std::vector<Ring> rings = {point_ring(radius, 0, Ring::Hold::all)};
    add_sphere_rings(rings, radius, 0, 0.25, steps,
                     held_ring(radius, 0, quartered(radius, steps.along), 0, Ring::Hold::some));
    add_sphere_rings(rings, radius, 0.25, 0.5, steps, point_ring(-radius, 0, Ring::Hold::all));
    return {zip_rings(rings, false), [radius](int, const Vec3& p) -> Vec3 { return p * (radius / length(p)); }};
}

Shape dome(const GeneratorOptions& options) {
    const double radius = options.radius;
    const Steps steps(options);
    const double angle = options.angle_deg / 360;
    const CosSin at_rim = cos_sin_turns(angle);
    const double rim_radius = radius * at_rim.sin;
    std::vector<Ring> rings = {point_ring(radius, 0, Ring::Hold::all)};
    const bool bulges = angle > 0.25;
    if (bulges)
        add_sphere_rings(rings, radius, 0, 0.25, steps,
                         held_ring(radius, 0, quartered(radius, steps.along), 0, Ring::Hold::some));
    add_sphere_rings(rings, radius, bulges ? 0.25 : 0, angle, steps,
                     held_ring(rim_radius, radius * at_rim.cos, quartered(rim_radius, steps.edge), 0, Ring::Hold::all));
    const double half_height = radius * (1 - at_rim.cos) / 2;
    const double centre = half_height - radius;
    for (Ring& ring : rings)
        ring.y += centre;
    rings.front().y = half_height;
    rings.back().y = -half_height;
    const Vec3 middle(0, centre, 0);
    return {zip_rings(rings, false), [radius, middle](int, const Vec3& p) -> Vec3 {
                const Vec3 from_middle = p - middle;
                return middle + from_middle * (radius / length(from_middle));
            }};
}

/// Rings of a flat ring or disc between two radii, neither included, from the inner to the outer.
std::vector<Ring> flat_rings(double inner, double outer, double y, const Steps& steps, int patch) {
    const int count = divisions(outer - inner, steps.across);
    std::vector<Ring> rings;
    for (int k = 1; k < count; ++k)
        rings.push_back(free_ring(inner + (outer - inner) * k / count, y, steps, patch));
    return rings;
}

Shape annulus(const GeneratorOptions& options) {
    const Steps steps(options);
    std::vector<Ring> rings = flat_rings(options.inner, options.outer, 0, steps, 0);
    const auto border = [&](double radius) {
        return held_ring(radius, 0, quartered(radius, steps.edge), 0, Ring::Hold::all);
    };
    rings.insert(rings.begin(), border(options.inner));
    rings.push_back(border(options.outer));
    return {zip_rings(rings, false), [](int, const Vec3& p) { return Vec3(p.x(), 0, p.z()); }};
}

enum CylinderPatch { cylinder_wall, cylinder_top, cylinder_bottom };

void add_cap(std::vector<Ring>& rings, double radius, double y, const Steps& steps, int patch) {
    std::vector<Ring> cap = flat_rings(0, radius, y, steps, patch);
    cap.insert(cap.begin(), point_ring(y, patch, Ring::Hold::none));
    if (patch == cylinder_bottom)
        std::reverse(cap.begin(), cap.end());
    rings.insert(rings.end(), cap.begin(), cap.end());
}

Shape cylinder(const GeneratorOptions& options) {
    const double radius = options.radius;
    const double half = options.height / 2;
    const bool regular = options.pattern == Pattern::regular;
    const Steps steps(options);
    const int rim = quartered(radius, steps.edge);
    std::vector<Ring> rings;
    if (options.caps)
        add_cap(rings, radius, half, steps, cylinder_top);
    rings.push_back(held_ring(radius, half, rim, cylinder_top, Ring::Hold::all));
    // An even number of rows keeps the two rims of a staggered wall alike.
    const int rows =
        regular ? 2 * divisions(options.height, 2 * steps.across) : divisions(options.height, steps.across);
    for (int k = 1; k < rows; ++k) {
        Ring ring = free_ring(radius, half - options.height * k / rows, steps, cylinder_wall);
        ring.count = regular ? rim : ring.count;
        ring.staggered = regular && k % 2 == 1;
        rings.push_back(ring);
    }
    rings.push_back(held_ring(radius, -half, rim, cylinder_wall, Ring::Hold::all));
    if (options.caps)
        add_cap(rings, radius, -half, steps, cylinder_bottom);
    return {zip_rings(rings, false), [radius, half](int patch, const Vec3& p) {
                if (patch != cylinder_wall)
                    return Vec3(p.x(), patch == cylinder_top ? half : -half, p.z());
                const double scale = radius / std::sqrt(p.x() * p.x() + p.z() * p.z());
                return Vec3(p.x() * scale, p.y(), p.z() * scale);
            }};
}

Shape torus(const GeneratorOptions& options) {
    const double radius = options.radius;
    const double tube = options.tube;
    const Steps steps(options);
    const int count = 4 * divisions(2 * pi * tube, 4 * steps.across); // rings at the top, bottom and outermost circles
    std::vector<Ring> rings;
    for (int k = 0; k < count; ++k) {
        const CosSin around = cos_sin_turns(static_cast<double>(k) / count);
        const double ring_radius = radius + tube * around.sin;
        const bool held = 4 * k % count == 0 && 4 * k / count != 3;
        rings.push_back(
            held ? held_ring(ring_radius, tube * around.cos, quartered(ring_radius, steps.along), 0, Ring::Hold::some)
                 : free_ring(ring_radius, tube * around.cos, steps, 0));
    }
    return {zip_rings(rings, true), [radius, tube](int, const Vec3& p) -> Vec3 {
                const double scale = radius / std::sqrt(p.x() * p.x() + p.z() * p.z());
                const Vec3 core(p.x() * scale, 0, p.z() * scale);
                const Vec3 from_core = p - core;
                return core + from_core * (tube / length(from_core));
            }};
}

/// A spheroid whose points are drawn toward its centre along `lobes` meridians: by the share 0.9/lobes s^2 g^2 with s
/// the distance from the axis on the unit sphere and g = (1 - cos(lobes phi))/2. Twice differentiable, the poles
/// included.
Vec3 pumpkin_point(const Vec3& p, double radius, double half_height, int lobes) {
    const Vec3 q(p.x() / radius, p.y() / half_height, p.z() / radius);
    const Vec3 unit = q / length(q);
    const double s = std::sqrt(unit.x() * unit.x() + unit.z() * unit.z());
    double factor = 1;
    if (s > 0) {
        const double c = unit.x() / s;
        const double d = unit.z() / s;
        double re = 1;
        double im = 0; // (c + i d)^lobes: cosine and sine of lobes times the angle
        for (int k = 0; k < lobes; ++k) {
            const double turned = re * c - im * d;
            im = re * d + im * c;
            re = turned;
        }
        const double groove = (1 - re) / 2;
        factor = 1 - 0.9 / lobes * s * s * groove * groove;
    }
    return {factor * radius * unit.x(), factor * half_height * unit.y(), factor * radius * unit.z()};
}

/// Points on the quarter ellipse (radius sin t, half_height cos t), from the pole to the equator, that cut it into
/// `count` equally long pieces; both ends included.
std::vector<Vec2> equal_arcs(double radius, double half_height, int count) {
    const int samples = 64 * count;
    std::vector<Vec2> curve;
    std::vector<double> run = {0};
    for (int i = 0; i <= samples; ++i) {
        const CosSin t = cos_sin_turns(0.25 * i / samples);
        curve.emplace_back(radius * t.sin, half_height * t.cos);
        if (i > 0) {
            const auto n = static_cast<std::size_t>(i);
            const double dx = curve[n].x() - curve[n - 1].x();
            const double dy = curve[n].y() - curve[n - 1].y();
            run.push_back(run.back() + std::sqrt(dx * dx + dy * dy));
        }
    }
    std::vector<Vec2> points;
    for (int k = 0; k < count; ++k) {
        const auto place = std::lower_bound(run.begin(), run.end(), run.back() * k / count);
        points.push_back(curve[static_cast<std::size_t>(place - run.begin())]);
    }
    points.push_back(curve.back());
    return points;
}

double lobed_circumference(const Ring& ring, const Deformation& deform, int lobes) {
    const int samples = 32 * lobes;
    double sum = 0;
    Vec3 last = deform({ring.radius, ring.y, 0});
    for (int i = 1; i <= samples; ++i) {
        const CosSin turn = cos_sin_turns(static_cast<double>(i) / samples);
        const Vec3 p = deform({ring.radius * turn.cos, ring.y, -ring.radius * turn.sin});
        sum += length(p - last);
        last = p;
    }
    return sum;
}

Shape pumpkin(const GeneratorOptions& options) {
    const double radius = options.radius;
    const double half = options.height / 2;
    const int lobes = options.lobes;
    const Steps steps(options);
    const Deformation deform = [=](const Vec3& p) { return pumpkin_point(p, radius, half, lobes); };
    const double quarter = pi / 2 * std::sqrt((radius * radius + half * half) / 2);
    const std::vector<Vec2> profile = equal_arcs(radius, half, divisions(quarter, steps.across, 2));
    std::vector<Ring> upper = {point_ring(half, 0, Ring::Hold::all)};
    for (std::size_t k = 1; k < profile.size(); ++k) {
        Ring ring = free_ring(profile[k].x(), profile[k].y(), steps, 0);
        ring.count = divisions(lobed_circumference(ring, deform, lobes), steps.along, 4);
        upper.push_back(ring);
    }
    // The tops of the ribs are held at the equator, where the shape is widest.
    const int pieces = divisions(lobed_circumference(upper.back(), deform, lobes), lobes * steps.along);
    upper.back() = held_ring(radius, 0, lobes * pieces, 0, Ring::Hold::some);
    upper.back().held_count = lobes;
    std::vector<Ring> rings = upper;
    for (std::size_t k = upper.size() - 1; k-- > 0;) {
        rings.push_back(upper[k]);
        rings.back().y = -upper[k].y;
    }
    return {zip_rings(rings, false, deform), [deform](int, const Vec3& p) { return deform(p); }};
}

} // namespace

Shape revolved(const GeneratorOptions& options) {
    switch (options.shape) {
    case GeneratorShape::sphere:
        return sphere(options);
    case GeneratorShape::cylinder:
        return cylinder(options);
    case GeneratorShape::dome:
        return dome(options);
    case GeneratorShape::torus:
        return torus(options);
    case GeneratorShape::annulus:
        return annulus(options);
    default:
        assert(options.shape == GeneratorShape::pumpkin);
        return pumpkin(options);
    }
}

} // namespace plisse
