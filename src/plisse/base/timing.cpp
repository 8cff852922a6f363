#include <plisse/base/timing.h>

namespace plisse {

namespace {
thread_local PhaseScope* innermost = nullptr;
}

const char* phase_name(Phase phase) {
    constexpr std::array<const char*, phase_count> names = {"elastic",     "contact", "linear_solve", "line_search",
                                                            "broad_phase", "ccd",     "other"};
    return names[static_cast<std::size_t>(phase)];
}

PhaseTimes& PhaseTimes::operator+=(const PhaseTimes& other) {
    for (std::size_t i = 0; i < seconds.size(); ++i)
        seconds[i] += other.seconds[i];
    return *this;
}

double PhaseTimes::total() const {
    double sum = 0;
    for (double s : seconds)
        sum += s;
    return sum;
}

PhaseScope::PhaseScope(PhaseTimes& times, Phase phase) : times_(times), phase_(phase), outer_(innermost) {
    innermost = this;
}

PhaseScope::~PhaseScope() {
    const double elapsed = watch_.seconds();
    times_[phase_] += elapsed - inner_seconds_;
    if (outer_)
        outer_->inner_seconds_ += elapsed;
    innermost = outer_;
}

} // namespace plisse
