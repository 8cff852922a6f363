#include <plisse/base/timing.h>

#include <thread>

#include <gtest/gtest.h>

namespace plisse {
namespace {

void wait(int milliseconds) {
    std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
}

TEST(PhaseScope, CountsItsLifetime) {
    PhaseTimes times;
    const Stopwatch watch;
    {
        const PhaseScope scope(times, Phase::ccd);
        wait(10);
    }
    EXPECT_GE(times[Phase::ccd], 0.009);
    EXPECT_LE(times[Phase::ccd], watch.seconds());
    EXPECT_EQ(times.total(), times[Phase::ccd]);
}

TEST(PhaseScope, GivesInnerTimeToTheInnerPhaseOnly) {
    PhaseTimes times;
    const Stopwatch watch;
    {
        const PhaseScope outer(times, Phase::line_search);
        wait(10);
        {
            const PhaseScope inner(times, Phase::elastic);
            wait(40);
            {
                const PhaseScope innermost(times, Phase::contact);
                wait(10);
            }
        }
        {
            const PhaseScope second(times, Phase::contact);
            wait(10);
        }
    }
    const double whole = watch.seconds();
    EXPECT_GE(times[Phase::line_search], 0.009);
    EXPECT_GE(times[Phase::elastic], 0.039);
    EXPECT_GE(times[Phase::contact], 0.018);
    // Phases do not overlap: together they are no longer than the clock says, and miss nothing.
    EXPECT_LE(times.total(), whole);
    EXPECT_GE(times.total(), 0.9 * whole);
    EXPECT_LE(times[Phase::line_search], whole - 0.058);
}

TEST(PhaseTimes, AddPhaseByPhase) {
    PhaseTimes a, b;
    a[Phase::ccd] = 1;
    b[Phase::ccd] = 2;
    b[Phase::other] = 4;
    a += b;
    EXPECT_EQ(a[Phase::ccd], 3);
    EXPECT_EQ(a[Phase::other], 4);
    EXPECT_EQ(a.total(), 7);
}

TEST(PhaseName, IsTheReportsKey) {
    EXPECT_STREQ(phase_name(Phase::elastic), "elastic");
    EXPECT_STREQ(phase_name(Phase::linear_solve), "linear_solve");
    EXPECT_STREQ(phase_name(Phase::other), "other");
}

} // namespace
} // namespace plisse
