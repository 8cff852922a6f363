#include <plisse/mesh/shapes.h>

#include <algorithm>
#include <map>

#include <plisse/mesh/portable_math.h>

namespace plisse {

namespace {

using Chain = std::vector<int>;

/// The vertices from corner a to corner b along a straight side, both included.
Chain side(PatchMesh& mesh, int a, int b, int count) {
    Chain chain = {a};
    const Chain inner = add_straight_points(mesh, mesh.point(a), mesh.point(b), count);
    chain.insert(chain.end(), inner.begin(), inner.end());
    chain.push_back(b);
    return chain;
}

Chain reversed(Chain chain) {
    std::reverse(chain.begin(), chain.end());
    return chain;
}

/// Fills a rectangle given its sides, each from corner to corner, counter-clockwise as seen from the front. A rectangle
/// one edge wide is a strip between its long sides; any other is a fan about its middle.
void fill_rectangle(PatchMesh& mesh, const std::array<Chain, 4>& sides, int patch) {
    for (std::size_t k = 0; k < 2; ++k)
        if (sides[k].size() == 2 && sides[k + 2].size() == 2) {
            mesh.zip(sides[(k + 1) % 4], reversed(sides[(k + 3) % 4]), patch);
            return;
        }
    const Vec3 middle = 0.5 * (mesh.point(sides[0].front()) + mesh.point(sides[2].front()));
    const Chain centre = {mesh.add_vertex(middle, patch)};
    for (const Chain& chain : sides)
        mesh.zip(chain, centre, patch);
}

std::array<int, 2> sheet_cells(const GeneratorOptions& options) {
    if (options.cells[0] > 0)
        return options.cells;
    return {divisions(options.size.x(), options.edge_length), divisions(options.size.y(), options.edge_length)};
}

/// Coordinate number i of n equal steps over [-size/2, size/2]; mirror images to the bit.
double grid_coordinate(int i, int n, double size) {
    return size * (2 * i - n) / (2.0 * n);
}

/// Two triangles of a grid cell with corners a, b, c, d in turn; the diagonal runs from a to c, or from b to d.
void add_cell(PatchMesh& mesh, const std::array<int, 4>& corners, bool from_first, int patch) {
    const auto& [a, b, c, d] = corners;
    if (from_first) {
        mesh.add_face({a, b, c}, patch);
        mesh.add_face({a, c, d}, patch);
    } else {
        mesh.add_face({a, b, d}, patch);
        mesh.add_face({b, c, d}, patch);
    }
}

PatchMesh sheet_grid(const GeneratorOptions& options) {
    const auto [nx, nz] = sheet_cells(options);
    PatchMesh mesh;
    for (int j = 0; j <= nz; ++j)
        for (int i = 0; i <= nx; ++i)
            mesh.add_vertex({grid_coordinate(i, nx, options.size.x()), 0, grid_coordinate(j, nz, options.size.y())}, 0);
    for (int j = 0; j < nz; ++j)
        for (int i = 0; i < nx; ++i) {
            const int a = j * (nx + 1) + i;
            const int b = a + nx + 1;
            const bool from_first = options.diagonals == Diagonals::one || (i + j) % 2 == 0;
            add_cell(mesh, {a, b, b + 1, a + 1}, from_first, 0);
        }
    return mesh;
}

PatchMesh sheet_start(const GeneratorOptions& options) {
    const double x = options.size.x() / 2;
    const double z = options.size.y() / 2;
    const int nx = divisions(options.size.x(), options.edge_length);
    const int nz = divisions(options.size.y(), options.edge_length);
    PatchMesh mesh;
    const std::array<Vec3, 4> corners = {Vec3(-x, 0, -z), Vec3(-x, 0, z), Vec3(x, 0, z), Vec3(x, 0, -z)};
    for (const Vec3& corner : corners)
        mesh.add_vertex(corner, PatchMesh::fixed);
    fill_rectangle(mesh, {side(mesh, 0, 1, nz), side(mesh, 1, 2, nx), side(mesh, 2, 3, nz), side(mesh, 3, 0, nx)}, 0);
    return mesh;
}

/// The six faces of a box: the axis of the normal, its sign, and the two axes u, v with u x v along the outward normal.
struct BoxFace {
    int axis, u, v;
    bool positive;
};
constexpr std::array<BoxFace, 6> box_faces = {
    {{0, 1, 2, true}, {0, 2, 1, false}, {1, 2, 0, true}, {1, 0, 2, false}, {2, 0, 1, true}, {2, 1, 0, false}}};

PatchMesh box_grid(const Vec3& size, const std::array<int, 3>& cells) {
    PatchMesh mesh;
    std::map<std::array<int, 3>, int> numbers;
    const auto vertex = [&](const std::array<int, 3>& at) {
        const auto [place, is_new] = numbers.try_emplace(at, mesh.vertex_count());
        if (is_new)
            mesh.add_vertex({grid_coordinate(at[0], cells[0], size.x()), grid_coordinate(at[1], cells[1], size.y()),
                             grid_coordinate(at[2], cells[2], size.z())},
                            PatchMesh::fixed);
        return place->second;
    };
    for (int f = 0; f < 6; ++f) {
        const BoxFace& face = box_faces[static_cast<std::size_t>(f)];
        const auto [axis, u, v] = std::array<std::size_t, 3>{
            static_cast<std::size_t>(face.axis), static_cast<std::size_t>(face.u), static_cast<std::size_t>(face.v)};
        const auto at = [&](int i, int j) {
            std::array<int, 3> place{};
            place[axis] = face.positive ? cells[axis] : 0;
            place[u] = i;
            place[v] = j;
            return vertex(place);
        };
        for (int j = 0; j < cells[v]; ++j)
            for (int i = 0; i < cells[u]; ++i)
                add_cell(mesh, {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)}, (i + j) % 2 == 0, f);
    }
    return mesh;
}

PatchMesh box_start(const Vec3& size, const std::array<int, 3>& cells) {
    PatchMesh mesh;
    for (int corner = 0; corner < 8; ++corner) // bit k: the high side of axis k
        mesh.add_vertex({(corner & 1 ? 0.5 : -0.5) * size.x(), (corner & 2 ? 0.5 : -0.5) * size.y(),
                         (corner & 4 ? 0.5 : -0.5) * size.z()},
                        PatchMesh::fixed);
    std::map<Edge, Chain> edges;
    const auto edge = [&](int a, int b, int axis) {
        const auto [place, is_new] = edges.try_emplace({std::min(a, b), std::max(a, b)});
        if (is_new)
            place->second = side(mesh, std::min(a, b), std::max(a, b), cells[static_cast<std::size_t>(axis)]);
        return a < b ? place->second : reversed(place->second);
    };
    for (int f = 0; f < 6; ++f) {
        const BoxFace& face = box_faces[static_cast<std::size_t>(f)];
        const int a = face.positive ? 1 << face.axis : 0;
        const int b = a | 1 << face.u;
        const int c = b | 1 << face.v;
        const int d = a | 1 << face.v;
        fill_rectangle(mesh, {edge(a, b, face.u), edge(b, c, face.v), edge(c, d, face.u), edge(d, a, face.v)}, f);
    }
    return mesh;
}

} // namespace

int divisions(double length, double step, int least) {
    return std::max(least, static_cast<int>(std::floor(length / step + 0.5)));
}

std::vector<int> add_straight_points(PatchMesh& mesh, Vec3 a, Vec3 b, int count) {
    std::vector<int> points;
    for (int i = 1; i < count; ++i) {
        const double t = static_cast<double>(i) / count;
        Vec3 p = (1 - t) * a + t * b;
        for (int k = 0; k < 3; ++k)
            if (a[k] == b[k])
                p[k] = a[k]; // exactly on the side, whatever the weights round to
        points.push_back(mesh.add_vertex(p, PatchMesh::fixed));
    }
    return points;
}

Shape flat_sheet(const GeneratorOptions& options) {
    return {options.pattern == Pattern::regular ? sheet_grid(options) : sheet_start(options),
            [](int, const Vec3& p) { return Vec3(p.x(), 0, p.z()); }};
}

Shape box(const GeneratorOptions& options) {
    const Vec3 size = options.size;
    const std::array<int, 3> cells = {divisions(size.x(), options.edge_length),
                                      divisions(size.y(), options.edge_length),
                                      divisions(size.z(), options.edge_length)};
    return {options.pattern == Pattern::regular ? box_grid(size, cells) : box_start(size, cells),
            [size](int patch, const Vec3& p) {
                const BoxFace& face = box_faces[static_cast<std::size_t>(patch)];
                Vec3 q = p;
                q[face.axis] = (face.positive ? 0.5 : -0.5) * size[face.axis];
                return q;
            }};
}

} // namespace plisse
