#include <plisse/solve/script_drive.h>

#include <algorithm>

namespace plisse {

ScriptDrive::ScriptDrive(const std::vector<std::uint8_t>& prescribed, const std::vector<int>& script_of)
    : prescribed_(prescribed), script_of_(script_of) {
    for (std::size_t i = 0; i < script_of_.size(); ++i)
        if (prescribed_[i])
            script_count_ = std::max(script_count_, script_of_[i] + 1);
}

bool ScriptDrive::is_driven(std::size_t unknown) const {
    return prescribed_[unknown] && (driven_ == all || script_of_[unknown] == driven_);
}

VecX ScriptDrive::step(const VecX& x, const VecX& targets, double tolerance) {
    VecX whole = VecX::Zero(x.size());
    for (Eigen::Index i = 0; i < x.size(); ++i)
        if (prescribed_[static_cast<std::size_t>(i)])
            whole[i] = targets[i] - x[i];
    if (whole.lpNorm<Eigen::Infinity>() <= tolerance)
        whole.setZero();
    remaining_ = whole.size() > 0 ? as_positions(whole).colwise().norm().maxCoeff() : 0.0;
    if (remaining_ == 0)
        penalty_.share = 0;
    while (state_ == State::driving && remaining_ > 0) {
        VecX step = VecX::Zero(x.size());
        for (Eigen::Index i = 0; i < x.size(); ++i)
            if (is_driven(static_cast<std::size_t>(i)))
                step[i] = whole[i];
        if (driven_ == all || step.lpNorm<Eigen::Infinity>() > tolerance)
            return step;
        drive_next();
    }
    return VecX::Zero(x.size());
}

void ScriptDrive::block() {
    if (driven_ != all) {
        drive_next();
    } else {
        futile_drives_ = penalty_.share > futile_share ? futile_drives_ + 1 : 0;
        if (futile_drives_ == most_futile_drives)
            drive_next();
    }
    if (state_ == State::driving)
        state_ = State::waiting;
    penalty_ = {};
}

void ScriptDrive::drive_next() {
    ++driven_;
    if (script_count_ == 1 || driven_ == script_count_)
        state_ = State::given_up;
    penalty_ = state_ == State::driving ? ScriptPenalty{1, 0} : ScriptPenalty{};
}

void ScriptDrive::go_on() {
    state_ = State::driving;
    penalty_ = {1, 0};
}

} // namespace plisse
