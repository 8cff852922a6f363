#pragma once

#include <stdexcept>
#include <string>

namespace plisse {

/// Input that cannot be used: thrown by file readers and the scene, caught by the command line and the bindings only.
/// `what()` reads "PLACE: WHAT; REMEDY", where the place is FILE, FILE:LINE, FILE:LINE:COLUMN or FILE/json/pointer.
class InputError : public std::runtime_error {
public:
    InputError(const std::string& place, const std::string& what_is_wrong, const std::string& what_would_be_right)
        : std::runtime_error(place + ": " + what_is_wrong + "; " + what_would_be_right), place_(place) {}
    const std::string& place() const { return place_; }
    /// The same with more to say at the end of its remedy.
    InputError with(const std::string& more) const { return InputError(place_, what() + (", " + more)); }

private:
    InputError(const std::string& place, const std::string& sentence) : std::runtime_error(sentence), place_(place) {}

    std::string place_;
};

} // namespace plisse
