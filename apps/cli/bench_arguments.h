#pragma once

#include <string>

namespace plisse {

/// What `plisse bench` was asked for.
struct BenchArguments {
    std::string name;
    std::string json, plot; ///< files; empty: none
    int threads = 0;
    bool quick = false;
    std::string scenario;  ///< of rmtr: the only one; empty: all
    int first_levels = 1;  ///< of rmtr: the fewest
    int levels = 0;        ///< of rmtr: the most; 0: as many as the bench has
    double time_limit = 0; ///< of rmtr, s, of one contestant; 0: the bench's own
};

} // namespace plisse
