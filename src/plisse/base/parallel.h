#pragma once

#include <cstddef>
#include <vector>

#ifdef __SANITIZE_THREAD__
#include <atomic>
#include <thread>
#else
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#endif

namespace plisse {

/// Sets how many threads parallel loops use for as long as the object lives. Results never depend on the number.
class ThreadLimit {
public:
    /// threads: at least 1; 0 takes the number of processors.
    explicit ThreadLimit(int threads);
    ~ThreadLimit();
    ThreadLimit(const ThreadLimit&) = delete;
    ThreadLimit& operator=(const ThreadLimit&) = delete;
    int threads() const { return threads_; }

private:
    int threads_;
    void* control_;
};

/// How many threads parallel loops use now.
int thread_count();

/// Runs body(i) for i in [0, count). The calls must not write to the same place: nothing orders them.
template <typename Body>
void parallel_for(int count, int grain, const Body& body) {
    if (count <= grain) {
        for (int i = 0; i < count; ++i)
            body(i);
        return;
    }
#ifdef __SANITIZE_THREAD__
    // The sanitizer cannot see into TBB's library and would call its hand-overs races, so it is shown plain threads.
    std::atomic<int> next = 0;
    const auto work = [&] {
        for (int begin = 0; (begin = next.fetch_add(grain, std::memory_order_relaxed)) < count;)
            for (int i = begin; i < begin + grain && i < count; ++i)
                body(i);
    };
    std::vector<std::thread> others;
    for (int k = 1; k < thread_count(); ++k)
        others.emplace_back(work);
    work();
    for (std::thread& other : others)
        other.join();
#else
    tbb::parallel_for(tbb::blocked_range<int>(0, count, static_cast<std::size_t>(grain)),
                      [&](const tbb::blocked_range<int>& range) {
                          for (int i = range.begin(); i < range.end(); ++i)
                              body(i);
                      });
#endif
}

/// Number of fixed-size chunks a deterministic reduction over `count` items uses; independent of the thread count.
inline int chunk_count(int count, int chunk_size) {
    return (count + chunk_size - 1) / chunk_size;
}

/// Runs body(chunk, begin, end) over fixed chunks of [0, count).
template <typename Body>
void parallel_chunks(int count, int chunk_size, const Body& body) {
    parallel_for(chunk_count(count, chunk_size), 1, [&](int chunk) {
        const int begin = chunk * chunk_size;
        body(chunk, begin, begin + chunk_size < count ? begin + chunk_size : count);
    });
}

/// Sum of term(i) over [0, count): the same bits for any number of threads, because the chunks and the order in which
/// their sums are added are fixed.
template <typename Term>
double parallel_sum(int count, const Term& term) {
    constexpr int chunk_size = 512;
    std::vector<double> sums(static_cast<std::size_t>(chunk_count(count, chunk_size)), 0.0);
    parallel_chunks(count, chunk_size, [&](int chunk, int begin, int end) {
        double sum = 0;
        for (int i = begin; i < end; ++i)
            sum += term(i);
        sums[static_cast<std::size_t>(chunk)] = sum;
    });
    double total = 0;
    for (double sum : sums)
        total += sum;
    return total;
}

} // namespace plisse
