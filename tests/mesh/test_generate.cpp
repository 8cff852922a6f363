#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>

#include <Eigen/Geometry>

#include <plisse/base/error.h>
#include <plisse/mesh/check_mesh.h>
#include <plisse/mesh/connectivity.h>
#include <plisse/mesh/generate.h>
#include <plisse/mesh/portable_math.h>

namespace plisse {
namespace {

struct Case {
    const char* name;
    GeneratorOptions options;
    int euler;
    int loops;
    Vec3 extent;                                   ///< of the bounding box; negative where it is not known exactly
    std::function<double(const Vec3&)> off;        ///< distance from the exact surface
    std::function<double(const Vec3&)> border_off; ///< distance of a border vertex from the exact border
    bool closed() const { return loops == 0; }
};

std::ostream& operator<<(std::ostream& out, const Case& c) {
    return out << c.name;
}

double nothing(const Vec3&) {
    return 0;
}
double around_axis(const Vec3& p) {
    return std::hypot(p.x(), p.z());
}

double off_box(const Vec3& p, const Vec3& size) {
    const Vec3 gap = (p.cwiseAbs() - size / 2).cwiseAbs();
    return (p.cwiseAbs() - size / 2).maxCoeff() > 0 ? (p.cwiseAbs() - size / 2).maxCoeff() : gap.minCoeff();
}

/// Distance from the wall or caps of a star whose section at height y is the outline turned and shrunk.
double off_star(const Vec3& p, const GeneratorOptions& o) {
    const double cap = std::abs(std::abs(p.y()) - o.height / 2);
    const double share = p.y() / o.height + 0.5;
    double best = 1e9;
    const auto corner = [&](int i, double turn) {
        const double r = i % 2 == 0 ? o.radius : o.radius * (1 - o.depth);
        const double a = pi * i / o.points + turn;
        return Vec2(r * std::cos(a), -r * std::sin(a));
    };
    const double half = o.twist_deg / 360 * pi;
    for (int i = 0; i < 2 * o.points; ++i) {
        const Vec2 a = (1 - share) * corner(i, -half) + share * corner(i, half);
        const Vec2 b = (1 - share) * corner(i + 1, -half) + share * corner(i + 1, half);
        const Vec2 q(p.x(), p.z());
        const double t = std::clamp((q - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
        best = std::min(best, (q - a - t * (b - a)).norm());
    }
    return std::min(cap, best);
}

std::vector<Case> cases() {
    std::vector<Case> list;
    GeneratorOptions o;
    o.size = {1.2, 0.8, 0};
    list.push_back(
        {"sheet",
         o,
         1,
         1,
         {1.2, 0, 0.8},
         [](const Vec3& p) { return std::abs(p.y()); },
         [](const Vec3& p) { return std::min(std::abs(std::abs(p.x()) - 0.6), std::abs(std::abs(p.z()) - 0.4)); }});
    o = {};
    o.shape = GeneratorShape::box;
    o.size = {1, 0.5, 0.7};
    list.push_back({"box", o, 2, 0, o.size, [](const Vec3& p) { return off_box(p, {1, 0.5, 0.7}); }, nothing});
    o = {};
    o.shape = GeneratorShape::sphere;
    list.push_back({"sphere", o, 2, 0, {1, 1, 1}, [](const Vec3& p) { return p.norm() - 0.5; }, nothing});
    o = {};
    o.shape = GeneratorShape::cylinder;
    const auto off_rim = [](const Vec3& p) {
        return std::max(std::abs(around_axis(p) - 0.5), std::abs(std::abs(p.y()) - 0.5));
    };
    list.push_back({"tube", o, 0, 2, {1, 1, 1}, [](const Vec3& p) { return around_axis(p) - 0.5; }, off_rim});
    o.caps = true;
    list.push_back({"cylinder",
                    o,
                    2,
                    0,
                    {1, 1, 1},
                    [](const Vec3& p) { return std::min(std::abs(around_axis(p) - 0.5), 0.5 - std::abs(p.y())); },
                    nothing});
    o = {};
    o.shape = GeneratorShape::dome;
    o.angle_deg = 60;
    list.push_back({"dome",
                    o,
                    1,
                    1,
                    {std::sqrt(0.75), 0.25, std::sqrt(0.75)},
                    [](const Vec3& p) { return (p - Vec3(0, -0.375, 0)).norm() - 0.5; },
                    [](const Vec3& p) {
                        return std::max(std::abs(p.y() + 0.125), std::abs(around_axis(p) - std::sqrt(0.1875)));
                    }});
    o.angle_deg = 130;
    const double cosine = std::cos(130 * pi / 180);
    list.push_back({"flask",
                    o,
                    1,
                    1,
                    {1, 0.5 * (1 - cosine), 1},
                    [=](const Vec3& p) { return (p - Vec3(0, 0.25 * (1 - cosine) - 0.5, 0)).norm() - 0.5; },
                    [=](const Vec3& p) { return p.y() + 0.25 * (1 - cosine); }});
    o = {};
    o.shape = GeneratorShape::torus;
    list.push_back({"torus",
                    o,
                    0,
                    0,
                    {1.4, 0.4, 1.4},
                    [](const Vec3& p) { return std::hypot(around_axis(p) - 0.5, p.y()) - 0.2; },
                    nothing});
    o = {};
    o.shape = GeneratorShape::annulus;
    list.push_back(
        {"annulus",
         o,
         0,
         2,
         {1, 0, 1},
         [](const Vec3& p) { return p.y(); },
         [](const Vec3& p) { return std::min(std::abs(around_axis(p) - 0.25), std::abs(around_axis(p) - 0.5)); }});
    o = {};
    o.shape = GeneratorShape::pumpkin;
    o.radius = 0.6;
    o.height = 0.9;
    list.push_back({"pumpkin",
                    o,
                    2,
                    0,
                    {1.2, 0.9, 1.2},
                    [](const Vec3& p) {
                        const Vec3 q = p.cwiseQuotient(Vec3(0.6, 0.45, 0.6));
                        const double s = around_axis(q) / q.norm();
                        const double groove = (1 - std::cos(8 * std::atan2(q.z(), q.x()))) / 2;
                        return q.norm() - (1 - 0.9 / 8 * s * s * groove * groove);
                    },
                    nothing});
    o = {};
    o.shape = GeneratorShape::star;
    o.twist_deg = 30;
    o.depth = 0.4;
    list.push_back({"star", o, 2, 0, {-1, 1, -1}, [=](const Vec3& p) { return off_star(p, o); }, nothing});
    return list;
}

struct Quality {
    double mean = 0, least = 2, mean_edge = 0;
};

Quality quality_of(const TriangleMesh& mesh) {
    Quality result;
    for (const auto& [a, b, c] : mesh.faces) {
        const Vec3 u = mesh.positions.col(b) - mesh.positions.col(a);
        const Vec3 v = mesh.positions.col(c) - mesh.positions.col(a);
        const double squares = u.squaredNorm() + v.squaredNorm() + (v - u).squaredNorm();
        const double q = 2 * std::sqrt(3.0) * u.cross(v).norm() / squares;
        result.mean += q / mesh.face_count();
        result.least = std::min(result.least, q);
        result.mean_edge += (u.norm() + v.norm() + (v - u).norm()) / (3 * mesh.face_count());
    }
    return result;
}

Vec3 normal_of(const TriangleMesh& mesh, const Face& face) {
    const Vec3 a = mesh.positions.col(face[0]);
    return (mesh.positions.col(face[1]) - a).cross(mesh.positions.col(face[2]) - a);
}

double volume_of(const TriangleMesh& mesh) {
    double volume = 0;
    for (const Face& face : mesh.faces)
        volume += normal_of(mesh, face).dot(mesh.positions.col(face[0])) / 6;
    return volume;
}

std::uint64_t hash_of(const TriangleMesh& mesh) {
    std::uint64_t hash = 14695981039346656037ULL;
    const auto add = [&](const void* data, std::size_t size) {
        for (std::size_t i = 0; i < size; ++i)
            hash = (hash ^ static_cast<const unsigned char*>(data)[i]) * 1099511628211ULL;
    };
    add(mesh.positions.data(), sizeof(double) * static_cast<std::size_t>(mesh.positions.size()));
    add(mesh.faces.data(), sizeof(Face) * mesh.faces.size());
    return hash;
}

/// Vertices that lie inside, with the number of faces around each of them; 0 for border vertices.
std::vector<int> inner_valences(const TriangleMesh& mesh) {
    std::vector<int> valence(static_cast<std::size_t>(mesh.vertex_count()), 0);
    for (const Face& face : mesh.faces)
        for (int v : face)
            ++valence[static_cast<std::size_t>(v)];
    const Connectivity connectivity(mesh.vertex_count(), mesh.faces);
    for (int e = 0; e < connectivity.edge_count(); ++e)
        if (connectivity.is_boundary_edge(e))
            for (int v : connectivity.edges()[static_cast<std::size_t>(e)])
                valence[static_cast<std::size_t>(v)] = 0;
    return valence;
}

class Generated : public testing::TestWithParam<std::tuple<Case, Pattern>> {
protected:
    const Case& shape() const { return std::get<0>(GetParam()); }
    GeneratorOptions options() const {
        GeneratorOptions o = shape().options;
        o.pattern = std::get<1>(GetParam());
        return o;
    }
    bool irregular() const { return std::get<1>(GetParam()) == Pattern::irregular; }
};

TEST_P(Generated, IsASoundManifoldOfTheRightTopology) {
    for (double edge : {0.05, 0.11}) {
        GeneratorOptions o = options();
        o.edge_length = edge;
        const TriangleMesh mesh = generate_mesh(o);
        const MeshCheck check = check_mesh(mesh);
        EXPECT_TRUE(check.usable()) << testing::PrintToString(describe_findings(check, mesh));
        EXPECT_EQ(check.euler_characteristic, shape().euler);
        EXPECT_EQ(check.boundary_loops, shape().loops);
        EXPECT_EQ(check.components, 1);
        EXPECT_EQ(check.unreferenced_vertices, 0);
    }
}

TEST_P(Generated, LiesOnItsSurfaceAndFillsItsBox) {
    const TriangleMesh mesh = generate_mesh(options());
    for (int v = 0; v < mesh.vertex_count(); ++v)
        EXPECT_NEAR(shape().off(mesh.positions.col(v)), 0, 1e-14);
    const bool shifted =
        !irregular() && shape().options.shape == GeneratorShape::sphere; // an icosphere: exact in y only
    for (int k = 0; k < 3; ++k) {
        if (shape().extent[k] < 0 || (shifted && k != 1))
            continue;
        EXPECT_NEAR(mesh.positions.row(k).maxCoeff(), shape().extent[k] / 2, 1e-15) << "axis " << k;
        EXPECT_NEAR(mesh.positions.row(k).minCoeff(), -shape().extent[k] / 2, 1e-15) << "axis " << k;
    }
    for (const auto& loop : boundary_loops(Connectivity(mesh.vertex_count(), mesh.faces), mesh.faces))
        for (int v : loop)
            EXPECT_NEAR(shape().border_off(mesh.positions.col(v)), 0, 1e-15);
}

TEST_P(Generated, TurnsItsFrontOutward) {
    const TriangleMesh mesh = generate_mesh(options());
    if (shape().closed()) {
        EXPECT_GT(volume_of(mesh), 0);
        return;
    }
    for (const Face& face : mesh.faces) {
        const Vec3 normal = normal_of(mesh, face);
        const Vec3 p = mesh.positions.col(face[0]);
        const bool flat = shape().extent.y() == 0;
        const bool tube = shape().options.shape == GeneratorShape::cylinder;
        const Vec3 middle(0, 0.5 * shape().extent.y() - 0.5, 0); // of a dome's sphere
        EXPECT_GT(normal.dot(flat ? Vec3(0, 1, 0) : tube ? Vec3(p.x(), 0, p.z()) : p - middle), 0);
    }
}

TEST_P(Generated, HasGoodTriangles) {
    const GeneratorOptions o = options();
    const TriangleMesh mesh = generate_mesh(o);
    const Quality quality = quality_of(mesh);
    EXPECT_GE(quality.mean, irregular() ? 0.94 : 0.86);
    EXPECT_GE(quality.least, irregular() ? 0.5 : 0.6);
    if (irregular()) {
        EXPECT_NEAR(quality.mean_edge, o.edge_length, 0.04 * o.edge_length);
    } else {
        EXPECT_NEAR(quality.mean_edge, o.edge_length, 0.2 * o.edge_length);
    }
}

TEST_P(Generated, FoldsNowhereBesideItsSharpEdges) {
    const GeneratorShape kind = shape().options.shape;
    const bool sharp = kind == GeneratorShape::box || kind == GeneratorShape::star || shape().options.caps;
    const TriangleMesh mesh = generate_mesh(options());
    const Connectivity connectivity(mesh.vertex_count(), mesh.faces);
    for (int e = 0; e < connectivity.edge_count(); ++e) {
        if (connectivity.is_boundary_edge(e))
            continue;
        const auto sides = connectivity.edge_faces(e);
        const Vec3 a = normal_of(mesh, mesh.faces[static_cast<std::size_t>(sides[0])]).normalized();
        const Vec3 b = normal_of(mesh, mesh.faces[static_cast<std::size_t>(sides[1])]).normalized();
        EXPECT_GT(a.dot(b), sharp ? -0.8 : 0.6);
    }
}

TEST_P(Generated, IsTheSameForTheSameSeedOnly) {
    GeneratorOptions o = options();
    const std::uint64_t hash = hash_of(generate_mesh(o));
    EXPECT_EQ(hash_of(generate_mesh(o)), hash);
    o.seed = 2;
    EXPECT_EQ(hash_of(generate_mesh(o)) != hash, irregular());
}

TEST_P(Generated, SurvivesEdgesOfAnyLength) {
    for (double edge : {0.2, 0.35, 0.6, 1.0, 5.0})
        for (std::uint64_t seed = 1; seed <= 5; ++seed) {
            GeneratorOptions o = options();
            o.edge_length = edge;
            o.seed = seed;
            const TriangleMesh mesh = generate_mesh(o);
            const MeshCheck check = check_mesh(mesh);
            EXPECT_TRUE(check.usable()) << edge << testing::PrintToString(describe_findings(check, mesh));
            EXPECT_EQ(check.euler_characteristic, shape().euler) << edge;
            EXPECT_EQ(check.boundary_loops, shape().loops) << edge;
        }
}

std::string name_of(const testing::TestParamInfo<std::tuple<Case, Pattern>>& tested) {
    const bool irregular = std::get<1>(tested.param) == Pattern::irregular;
    return std::get<0>(tested.param).name + std::string(irregular ? "Irregular" : "Regular");
}

INSTANTIATE_TEST_SUITE_P(Shapes, Generated,
                         testing::Combine(testing::ValuesIn(cases()),
                                          testing::Values(Pattern::irregular, Pattern::regular)),
                         name_of);

TEST(Generate, IrregularMeansManyValencesMostlyFiveToSeven) {
    for (const Case& shape : cases()) {
        int inner = 0;
        int six = 0;
        int usual = 0;
        for (int valence : inner_valences(generate_mesh(shape.options))) {
            inner += valence > 0;
            six += valence == 6;
            usual += valence >= 5 && valence <= 7;
        }
        EXPECT_LT(six, 0.75 * inner) << shape;
        EXPECT_GT(six, 0.35 * inner) << shape;
        EXPECT_GT(usual, 0.9 * inner) << shape;
    }
}

/// The generators promise the same bits on every machine and for every compiler flag.
TEST(Generate, MakesTheBitsItMadeElsewhere) {
    std::uint64_t all = 0;
    for (const Case& shape : cases())
        for (Pattern pattern : {Pattern::irregular, Pattern::regular}) {
            GeneratorOptions o = shape.options;
            o.pattern = pattern;
            all = all * 31 + hash_of(generate_mesh(o));
        }
    EXPECT_EQ(all, 1013713355201430559u);
}

TEST(Generate, CutsRegularSheetsIntoCells) {
    GeneratorOptions o;
    o.pattern = Pattern::regular;
    o.cells = {3, 2};
    TriangleMesh mesh = generate_mesh(o);
    EXPECT_EQ(mesh.vertex_count(), 12);
    EXPECT_EQ(mesh.face_count(), 12);
    EXPECT_EQ(mesh.positions.col(0), Vec3(-0.5, 0, -0.5));
    EXPECT_EQ(mesh.positions.col(3), Vec3(0.5, 0, -0.5));
    EXPECT_EQ(mesh.positions.col(11), Vec3(0.5, 0, 0.5));
    o.cells = {4, 4};
    for (auto [diagonals, largest] : {std::pair(Diagonals::alternating, 8), std::pair(Diagonals::one, 6)}) {
        o.diagonals = diagonals;
        const std::vector<int> valences = inner_valences(generate_mesh(o));
        EXPECT_EQ(*std::max_element(valences.begin(), valences.end()), largest);
    }
}

TEST(Generate, KeepsThinShapesSound) {
    for (const Vec3& size : {Vec3(1, 0.01, 1), Vec3(0.3, 0.01, 0.02), Vec3(1, 0.12, 0.06)})
        for (Pattern pattern : {Pattern::irregular, Pattern::regular}) {
            GeneratorOptions o;
            o.pattern = pattern;
            o.size = size;
            EXPECT_TRUE(check_mesh(generate_mesh(o)).usable()) << size.transpose();
            o.shape = GeneratorShape::box;
            EXPECT_TRUE(check_mesh(generate_mesh(o)).usable()) << size.transpose();
        }
    for (double inner : {0.05, 0.4, 0.49}) {
        GeneratorOptions o;
        o.shape = GeneratorShape::annulus;
        o.inner = inner;
        EXPECT_TRUE(check_mesh(generate_mesh(o)).usable()) << inner;
    }
}

TEST(Generate, MakesSoundStarsOrRefusesThem) {
    GeneratorOptions o;
    o.shape = GeneratorShape::star;
    o.height = 0.3;
    o.twist_deg = 60;
    for (o.points = 3; o.points <= 12; o.points += 3)
        for (double depth : {0.05, 0.3, 0.6}) {
            o.depth = depth;
            EXPECT_TRUE(check_mesh(generate_mesh(o)).usable()) << o.points << " " << depth;
        }
    o.points = 40;
    o.edge_length = 0.03;
    EXPECT_TRUE(check_mesh(generate_mesh(o)).usable());
    o.edge_length = 0.1;
    EXPECT_THROW(generate_mesh(o), InputError);
}

TEST(Generate, RefusesOptionsThatMakeNoMesh) {
    const auto refused = [](const std::function<void(GeneratorOptions&)>& change) {
        GeneratorOptions o;
        o.edge_length = 0.2;
        change(o);
        try {
            generate_mesh(o);
        } catch (const InputError& error) {
            return error.place().empty() && std::string(error.what()).find("; ") != std::string::npos;
        }
        return false;
    };
    const double nan = std::nan("");
    for (double bad : {0.0, -1.0, nan, std::numeric_limits<double>::infinity()}) {
        EXPECT_TRUE(refused([=](auto& o) { o.edge_length = bad; }));
        EXPECT_TRUE(refused([=](auto& o) { o.size.y() = bad; }));
        EXPECT_TRUE(refused([=](auto& o) { o.shape = GeneratorShape::box, o.size.z() = bad; }));
        for (GeneratorShape shape : {GeneratorShape::sphere, GeneratorShape::cylinder, GeneratorShape::dome,
                                     GeneratorShape::torus, GeneratorShape::pumpkin, GeneratorShape::star})
            EXPECT_TRUE(refused([=](auto& o) { o.shape = shape, o.radius = bad; }));
        for (GeneratorShape shape : {GeneratorShape::cylinder, GeneratorShape::pumpkin, GeneratorShape::star})
            EXPECT_TRUE(refused([=](auto& o) { o.shape = shape, o.height = bad; }));
        EXPECT_TRUE(refused([=](auto& o) { o.shape = GeneratorShape::torus, o.tube = bad; }));
        EXPECT_TRUE(refused([=](auto& o) { o.shape = GeneratorShape::annulus, o.inner = bad; }));
        EXPECT_TRUE(refused([=](auto& o) { o.shape = GeneratorShape::star, o.depth = bad; }));
    }
    EXPECT_TRUE(refused([](auto& o) { o.shape = GeneratorShape::torus, o.tube = 0.5; }));
    EXPECT_TRUE(refused([](auto& o) { o.shape = GeneratorShape::annulus, o.inner = 0.5; }));
    for (double angle : {0.0, 180.0, std::nan("")})
        EXPECT_TRUE(refused([=](auto& o) { o.shape = GeneratorShape::dome, o.angle_deg = angle; }));
    for (int count : {-1, 2, 100000}) {
        EXPECT_TRUE(refused([=](auto& o) { o.shape = GeneratorShape::pumpkin, o.lobes = count; }));
        EXPECT_TRUE(refused([=](auto& o) { o.shape = GeneratorShape::star, o.points = count; }));
    }
    EXPECT_TRUE(refused([](auto& o) { o.shape = GeneratorShape::star, o.twist_deg = 180; }));
    EXPECT_TRUE(refused([](auto& o) { o.edge_length = 1e-4; }));
    EXPECT_TRUE(refused([](auto& o) { o.edge_length = 1e-300; }));
    EXPECT_TRUE(refused([](auto& o) { o.pattern = Pattern::regular, o.cells = {4, 0}; }));
    EXPECT_TRUE(refused([](auto& o) { o.pattern = Pattern::regular, o.cells = {-4, 4}; }));
    EXPECT_TRUE(refused([](auto& o) { o.pattern = Pattern::regular, o.cells = {100000, 100000}; }));
    EXPECT_FALSE(refused([](auto&) {}));
}

TEST(PortableMath, TurnsAgreeWithTheLibraryAndMirrorExactly) {
    for (int k = -4000; k <= 4000; ++k) {
        const double turns = k / 1000.0;
        const CosSin c = cos_sin_turns(turns);
        EXPECT_NEAR(c.cos, std::cos(2 * pi * turns), 3e-15);
        EXPECT_NEAR(c.sin, std::sin(2 * pi * turns), 3e-15);
    }
    for (int k = 0; k <= 64; ++k) {
        const CosSin c = cos_sin_turns(k / 64.0);
        EXPECT_EQ(cos_sin_turns(1 - k / 64.0).cos, c.cos);
        EXPECT_EQ(cos_sin_turns(1 - k / 64.0).sin, -c.sin);
        EXPECT_EQ(cos_sin_turns(0.25 - k / 64.0).cos, c.sin);
    }
    EXPECT_EQ(cos_sin_turns(0.25).cos, 0);
    EXPECT_EQ(cos_sin_turns(0.5).cos, -1);
    EXPECT_EQ(cos_sin_turns(0.75).sin, -1);
}

} // namespace
} // namespace plisse
