#include <plisse/subdivide/face_ring.h>

namespace plisse {

const std::array<std::array<int, 2>, 16> ordinary_places = {{{0, 0},
                                                             {1, 0},
                                                             {1, 1},
                                                             {0, 1},
                                                             {-1, 0},
                                                             {-1, -1},
                                                             {0, -1},
                                                             {1, -1},
                                                             {2, -1},
                                                             {2, 0},
                                                             {2, 1},
                                                             {2, 2},
                                                             {1, 2},
                                                             {0, 2},
                                                             {-1, 2},
                                                             {-1, 1}}};

FaceRing face_ring(const ControlMesh& mesh, const QuadConnectivity& connectivity, int face) {
    using Q = QuadConnectivity;
    FaceRing ring;
    const Quad& corners = mesh.faces[static_cast<std::size_t>(face)];
    ring.points.assign(corners.begin(), corners.end());
    for (int c = 0; c < 4; ++c) {
        const int last = connectivity.to(4 * face + c);
        int side = connectivity.rotated(4 * face + c);
        int valence = 3;
        ring.points.push_back(connectivity.from(Q::previous(side)));
        for (side = connectivity.rotated(side); connectivity.from(Q::previous(side)) != last;
             side = connectivity.rotated(side)) {
            ring.points.push_back(connectivity.to(Q::next(side)));
            ring.points.push_back(connectivity.from(Q::previous(side)));
            ++valence;
        }
        ring.valence[static_cast<std::size_t>(c)] = valence;
    }
    return ring;
}

ControlMesh ring_mesh(const std::array<int, 4>& valence) {
    std::array<int, 4> first{}, last{};
    int count = 4;
    for (std::size_t c = 0; c < 4; ++c) {
        first[c] = count;
        count += 2 * valence[c] - 5;
        last[c] = count - 1;
    }
    ControlMesh mesh;
    mesh.vertex_count = count;
    mesh.domain_vertex_count = 4;
    mesh.domain_face_count = 1;
    mesh.faces = {{0, 1, 2, 3}};
    for (std::size_t c = 0; c < 4; ++c) {
        const std::size_t before = (c + 3) % 4;
        const int corner = static_cast<int>(c);
        mesh.faces.push_back({corner, static_cast<int>(before), last[before], first[c]});
        for (int e = first[c]; e < last[c]; e += 2)
            mesh.faces.push_back({corner, e, e + 1, e + 2});
    }
    return mesh;
}

} // namespace plisse
