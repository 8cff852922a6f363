#include <gtest/gtest.h>

#include <limits>

#include <Eigen/Cholesky>

#include <plisse/linalg/panel_cholesky.h>

using namespace plisse;

namespace {

template <typename Scalar>
class PanelCholeskyOf : public testing::Test {
protected:
    using Matrix = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;

    /// The panel of a positive definite matrix whose rows behind the pivots are any; what has no meaning is not a
    /// number.
    static Matrix panel(int pivots, int reach) {
        const int rows = pivots + reach;
        Matrix panel(rows + panel_row_multiple - 1 - (rows - 1) % panel_row_multiple, pivots);
        panel.setConstant(std::numeric_limits<Scalar>::quiet_NaN());
        for (int j = 0; j < pivots; ++j)
            for (int i = j; i < rows; ++i)
                panel(i, j) = i == j ? Scalar(pivots + 1) : Scalar((7 * i + 13 * j) % 11 - 5) / 6;
        return panel;
    }
};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(PanelCholeskyOf, Precisions);

TYPED_TEST(PanelCholeskyOf, FactorizesPanelsOfManySizesAsEigenDoes) {
    for (const int pivots : {3, 6, 21, 48, 51, 102, 147})
        for (const int reach : {0, 3, 9, 60, 201}) {
            auto panel = this->panel(pivots, reach);
            const Eigen::MatrixXd before = panel.topRows(pivots + reach).template cast<double>();
            ASSERT_TRUE(factorize_panel(static_cast<int>(panel.rows()), pivots, panel.data()));
            const Eigen::MatrixXd l = before.topRows(pivots).template selfadjointView<Eigen::Lower>().llt().matrixL();
            const Eigen::MatrixXd below =
                l.template triangularView<Eigen::Lower>().solve(before.bottomRows(reach).transpose()).transpose();
            const Eigen::MatrixXd after = panel.template cast<double>();
            const double rounding = 10 * pivots * std::numeric_limits<TypeParam>::epsilon();
            const Eigen::MatrixXd top = after.topRows(pivots).template triangularView<Eigen::Lower>();
            EXPECT_LT((top - l).norm(), rounding * l.norm()) << pivots << " " << reach;
            EXPECT_LE((after.middleRows(pivots, reach) - below).norm(), rounding * below.norm())
                << pivots << " " << reach;
        }
}

TYPED_TEST(PanelCholeskyOf, RefusesWhatIsNotPositiveDefiniteOrNotANumber) {
    for (const int at : {0, 1, 2, 30, 95})
        for (const double bad : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
            auto panel = this->panel(96, 12);
            panel(at, at) = static_cast<TypeParam>(bad);
            EXPECT_FALSE(factorize_panel(static_cast<int>(panel.rows()), 96, panel.data())) << at << " " << bad;
        }
}

} // namespace
