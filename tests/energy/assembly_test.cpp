#include <plisse/energy/assembly.h>

#include <gtest/gtest.h>

#include <limits>

#include <energy/shell_fixtures.h>
#include <linalg/dense_system.h>
#include <plisse/base/parallel.h>

namespace plisse {
namespace {

using testing::Cells;
using testing::make_sheet;

/// A sheet large enough that every loop is cut into many pieces.
struct Fixture {
    TriangleMesh mesh;
    MembraneEnergy membrane;
    HingeEnergy hinges;
    Positions x;
    explicit Fixture(int n)
        : mesh(make_sheet(n, n, 1, 1, Cells::random, 0.2)),
          membrane(testing::make_membrane(mesh, plane_stress_lame(1e5, .3), 1e-3)),
          hinges(testing::make_hinges(mesh, 1e-4, false, HingeHessian::projected)),
          x(testing::perturbed(mesh.positions, 0.2 / n)) {}
};

NewtonSystem assembled_system(const Fixture& fixture, const ElementEnergy& energy) {
    ElementAssembly assembly(energy, fixture.mesh.vertex_count());
    NewtonSystem system(std::vector<std::uint8_t>(static_cast<std::size_t>(fixture.x.size()), 0), assembly.pairs());
    system.set_prescribed_step(VecX::Zero(fixture.x.size()));
    assembly.place_in(system);
    system.begin({});
    assembly.add_hessian(fixture.x, system, true);
    return system;
}

TEST(ElementAssembly, SumsElementsOneByOne) {
    const Fixture fixture(6);
    for (const ElementEnergy* energy :
         {static_cast<const ElementEnergy*>(&fixture.membrane), static_cast<const ElementEnergy*>(&fixture.hinges)}) {
        double value = 0;
        Positions gradient = Positions::Ones(3, fixture.x.cols());
        for (int e = 0; e < energy->element_count(); ++e) {
            value += energy->value(e, fixture.x);
            std::array<double, 12> local;
            energy->gradient(e, fixture.x, local.data());
            for (std::size_t k = 0; k < energy->vertices(e).size(); ++k)
                gradient.col(energy->vertices(e)[k]) += Eigen::Map<const Vec3>(local.data() + 3 * k);
        }
        const ElementAssembly assembly(*energy, fixture.mesh.vertex_count());
        Positions sum = Positions::Ones(3, fixture.x.cols());
        assembly.add_gradient(fixture.x, sum);
        EXPECT_NEAR(assembly.value(fixture.x) / value, 1, 1e-13);
        EXPECT_LT((sum - gradient).cwiseAbs().maxCoeff(), 1e-13 * gradient.cwiseAbs().maxCoeff());
        const Eigen::MatrixXd hessian = testing::total_hessian(*energy, as_vector(fixture.x), true);
        EXPECT_LT((dense(assembled_system(fixture, *energy)) - hessian).norm(), 1e-13 * hessian.norm());
    }
}

TEST(ElementAssembly, GivesTheSameBitsForAnyNumberOfThreads) {
    const Fixture fixture(40);
    const ElementAssembly assembly(fixture.hinges, fixture.mesh.vertex_count());
    std::vector<double> values;
    std::vector<Positions> gradients;
    std::vector<std::vector<Mat3>> hessians;
    for (int threads : {1, 2, 4}) {
        const ThreadLimit limit(threads);
        values.push_back(assembly.value(fixture.x));
        gradients.push_back(Positions::Zero(3, fixture.x.cols()));
        assembly.add_gradient(fixture.x, gradients.back());
        hessians.push_back(assembled_system(fixture, fixture.hinges).blocks());
    }
    for (std::size_t k = 1; k < values.size(); ++k) {
        EXPECT_EQ(values[k], values[0]);
        EXPECT_EQ(gradients[k], gradients[0]);
        EXPECT_EQ(hessians[k], hessians[0]);
    }
}

TEST(ElementAssembly, ListsEachPairOnce) {
    const TriangleMesh mesh = make_sheet(1, 1, 1, 1); // faces (0, 1, 3) and (0, 3, 2)
    const MembraneEnergy membrane = testing::make_membrane(mesh, {1, 1}, 1);
    EXPECT_EQ(ElementAssembly(membrane, 4).pairs(), (std::vector<Edge>{{0, 1}, {0, 2}, {0, 3}, {1, 3}, {2, 3}}));
    const HingeEnergy hinges = testing::make_hinges(mesh, 1);
    EXPECT_EQ(ElementAssembly(hinges, 4).pairs().size(), 6u);
}

TEST(ElementAssembly, OneDegenerateElementMakesTheSumInfinite) {
    Fixture fixture(6);
    fixture.x.col(fixture.mesh.faces[5][0]) = fixture.x.col(fixture.mesh.faces[5][1]);
    const ElementAssembly assembly(fixture.membrane, fixture.mesh.vertex_count());
    EXPECT_EQ(assembly.value(fixture.x), std::numeric_limits<double>::infinity());
}

} // namespace
} // namespace plisse
