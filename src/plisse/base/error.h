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

private:
    std::string place_;
};

} // namespace plisse
