#pragma once

#include <chrono>
#include <deque>

namespace plisse::studio {

/// How many steps a second there are of late.
class StepRate {
public:
    using Clock = std::chrono::steady_clock;

    void add(Clock::time_point end) {
        ends_.push_back(end);
        if (ends_.size() > most_steps)
            ends_.pop_front();
    }
    void clear() { ends_.clear(); }

    /// Over the last steps, none of them older than 3 s; 0 when they are less than two.
    double per_second(Clock::time_point now) {
        while (!ends_.empty() && now - ends_.front() > std::chrono::seconds(3))
            ends_.pop_front();
        if (ends_.size() < 2)
            return 0;
        const std::chrono::duration<double> time = ends_.back() - ends_.front();
        return static_cast<double>(ends_.size() - 1) / time.count();
    }

private:
    static constexpr std::size_t most_steps = 40;
    std::deque<Clock::time_point> ends_;
};

} // namespace plisse::studio
