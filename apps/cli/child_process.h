#pragma once

#include <functional>

#include <nlohmann/json.hpp>

#include <plisse/base/context.h>

namespace plisse {

/// Does work in a process of its own, so that the most memory it held is known and is given back, and returns the
/// object that it came to with "peak_memory_bytes" of that process; {"error": why} where it came to nothing. This
/// process must have one thread. When the context is cancelled, the child's copy of it is too.
nlohmann::ordered_json in_child_process(const std::function<nlohmann::ordered_json()>& work, const Context& context);

} // namespace plisse
