#include <plisse/base/parallel.h>

#include <tbb/global_control.h>
#include <tbb/info.h>

namespace plisse {

ThreadLimit::ThreadLimit(int threads)
    : threads_(threads > 0 ? threads : tbb::info::default_concurrency()),
      control_(
          new tbb::global_control(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads_))) {}

ThreadLimit::~ThreadLimit() {
    delete static_cast<tbb::global_control*>(control_);
}

int thread_count() {
    return static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}

} // namespace plisse
