#include <gtest/gtest.h>

#include <Eigen/Dense>

#include <plisse/model/surface_contact.h>

#include "cloth_models.h"

namespace plisse {
namespace {

/// Two levels of a sheet within reach of the ground, each with its view of the contact.
class SurfaceContacts : public ::testing::Test {
protected:
    SurfaceContacts() : model_(square_metre(2, MaterialLaw::denim_stable, anywhere)) {
        model_.contact.distance = 4e-3;
        model_.contact.friction = 0.5;
        model_.contact.friction_velocity = 1e-3;
        add_ground(model_, ground);
        shared_ = std::make_unique<SurfaceContact>(model_, context_);
        const VertexWeights limits = model_.levels.limit_points(1).weights;
        fine_ = std::make_unique<LevelContact>(*shared_, limits);
        coarse_ = std::make_unique<LevelContact>(*shared_, VertexWeights(limits * model_.levels.subdivision(0)));
    }

    static constexpr double ground = -0.02; // further away at rest than surfaces repel

    /// Down to 2 mm above the ground, and a little out of flat, so that pairs differ.
    Positions bent(int level) const {
        Positions x = model_.levels.rest(level);
        for (Eigen::Index v = 0; v < x.cols(); ++v)
            x(1, v) += ground + 2e-3 + 3e-4 * std::sin(7 * x(0, v)) * std::cos(5 * x(2, v) + 0.3);
        return x;
    }
    static Eigen::MatrixXd dense(const NewtonSystem& system) {
        const Eigen::Index n = 3 * system.vertex_count();
        Eigen::MatrixXd h(n, n);
        for (Eigen::Index i = 0; i < n; ++i)
            h.col(i) = system.multiply(VecX::Unit(n, i));
        return h;
    }
    static Eigen::MatrixXd hessian(LevelContact& contact, const Positions& q) {
        std::vector<Edge> diagonal;
        for (int v = 0; v < q.cols(); ++v)
            diagonal.push_back({v, v});
        NewtonSystem system(std::vector<std::uint8_t>(static_cast<std::size_t>(q.size()), 0), diagonal);
        system.set_prescribed_step(VecX::Zero(q.size()));
        system.begin(contact.find_hessian(q, false));
        contact.add_hessian(system);
        return dense(system);
    }

    /// Both against differences.
    static void expect_derivatives(LevelContact& contact, const Positions& q) {
        Positions gradient = Positions::Zero(3, q.cols());
        contact.add_gradient(q, gradient);
        const Eigen::MatrixXd h = hessian(contact, q);
        constexpr double step = 1e-7;
        Positions slopes = q;
        Eigen::MatrixXd curvatures(q.size(), q.size());
        for (Eigen::Index i = 0; i < q.size(); ++i) {
            Positions before = q, after = q;
            before.reshaped()[i] -= step;
            after.reshaped()[i] += step;
            slopes.reshaped()[i] = (contact.value(after) - contact.value(before)) / (2 * step);
            Positions g_before = Positions::Zero(3, q.cols()), g_after = g_before;
            contact.add_gradient(before, g_before);
            contact.add_gradient(after, g_after);
            curvatures.col(i) = (g_after - g_before).reshaped() / (2 * step);
        }
        EXPECT_LT((slopes - gradient).norm(), 1e-6 * gradient.norm());
        EXPECT_LT((curvatures - h).norm(), 1e-5 * h.norm());
    }

    Context context_;
    SubdivisionModel model_;
    std::unique_ptr<SurfaceContact> shared_;
    std::unique_ptr<LevelContact> fine_, coarse_;
};

TEST_F(SurfaceContacts, RepelsWithDerivativesThatAgreeWithDifferences) {
    for (LevelContact* contact : {coarse_.get(), fine_.get()}) {
        const Positions q = bent(contact == coarse_.get() ? 0 : 1);
        EXPECT_GT(contact->value(q), 0);
        EXPECT_EQ(contact->friction(q), 0);
        EXPECT_LT(contact->min_gap(q), 2.4e-3);
        expect_derivatives(*contact, q);
    }
}

TEST_F(SurfaceContacts, RubsWithDerivativesThatAgreeWithDifferences) {
    for (LevelContact* contact : {coarse_.get(), fine_.get()}) {
        const Positions start = bent(contact == coarse_.get() ? 0 : 1);
        shared_->begin_step(contact->limit_points(start), {}, 1);
        Positions q = start;
        q.row(0).array() += 2e-5 * (1 + start.row(2).array()); // some stick, others slide
        q.row(1).array() += 1e-4;
        EXPECT_GT(contact->friction(q), 0);
        expect_derivatives(*contact, q);
        Positions up = start;
        up.row(1).array() += 1; // where nothing repels, what presses is still that of the start
        up.row(0).array() += 1e-5;
        EXPECT_GT(contact->friction(up), 0);
        expect_derivatives(*contact, up);
    }
}

TEST_F(SurfaceContacts, ObstaclesGoAsFarAsTheClothLeavesThem) {
    model_.obstacle_motions[0].translate.keys = {{0, Vec3::Zero()}, {1, Vec3(0, 0.1, 0)}};
    const Positions surface = coarse_->limit_points(bent(0));
    const Positions before = shared_->obstacles();
    const double share = shared_->move_obstacles(surface, 1);
    EXPECT_GT(share, 0);
    EXPECT_LT(0.1 * share, 2e-3);
    EXPECT_LT((shared_->obstacles() - before - share * (model_.obstacles_at(1) - before)).norm(), 1e-15);
    EXPECT_NE(shared_->held_up(surface, 1).find("\"ground\" is held up"), std::string::npos);
    Positions above = surface;
    above.row(1).array() += 1;
    EXPECT_EQ(shared_->move_obstacles(above, 1), 1);
    EXPECT_EQ(shared_->obstacles(), model_.obstacles_at(1));
}

TEST_F(SurfaceContacts, CoarseStatesStandWhereTheirSubdivisionDoes) {
    const Positions q = bent(0);
    const Positions subdivided = q * model_.levels.subdivision(0).transpose();
    EXPECT_LT((coarse_->limit_points(q) - fine_->limit_points(subdivided)).norm(), 1e-12);
    EXPECT_NEAR(coarse_->value(q), fine_->value(subdivided), 1e-12);
    const Eigen::MatrixXd s = Eigen::MatrixXd(model_.levels.subdivision(0));
    Eigen::MatrixXd s3 = Eigen::MatrixXd::Zero(3 * s.rows(), 3 * s.cols());
    for (Eigen::Index i = 0; i < s.rows(); ++i)
        for (Eigen::Index j = 0; j < s.cols(); ++j)
            s3.block<3, 3>(3 * i, 3 * j) = s(i, j) * Mat3::Identity();
    const Eigen::MatrixXd carried = s3.transpose() * hessian(*fine_, subdivided) * s3;
    EXPECT_LT((hessian(*coarse_, q) - carried).norm(), 1e-9 * carried.norm());
}

TEST_F(SurfaceContacts, CorrectionsBeginWhereTheFinerLevelIs) {
    Positions fine = bent(1);
    fine(1, 10) += 1e-3; // what no coarse state has
    const Positions coarse = fine * model_.levels.projection(0).transpose();
    coarse_->correct(coarse, fine_->limit_points(fine));
    EXPECT_NEAR(coarse_->value(coarse), fine_->value(fine), 1e-15);
    Positions of_fine = Positions::Zero(3, fine.cols()), of_coarse = Positions::Zero(3, coarse.cols());
    fine_->add_gradient(fine, of_fine);
    coarse_->add_gradient(coarse, of_coarse);
    EXPECT_LT((of_coarse - of_fine * model_.levels.subdivision(0)).norm(), 1e-12 * of_fine.norm());
    coarse_->stand_alone();
    EXPECT_GT(std::abs(coarse_->value(coarse) - fine_->value(fine)), 1e-6 * fine_->value(fine));
}

TEST_F(SurfaceContacts, NoStepLeadsThroughTheGround) {
    const Positions q = bent(0);
    Positions down = Positions::Zero(3, q.cols());
    down.row(1).setConstant(-0.1);
    const double alpha = coarse_->max_step(q, down);
    EXPECT_GT(alpha, 0);
    EXPECT_LT(0.1 * alpha, 2e-3);
    EXPECT_EQ(coarse_->max_step(q, Positions(-down)), 1);
}

} // namespace
} // namespace plisse
