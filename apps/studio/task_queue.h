#pragma once

#include <condition_variable>
#include <mutex>
#include <utility>
#include <vector>

#include <plisse/base/context.h>

namespace plisse::studio {

/// Tasks on their way from many threads to one. A task may cut short what that one is at.
template <typename Task>
class TaskQueue {
public:
    /// working: what is cancelled when a task cuts it short; must outlive the queue.
    explicit TaskQueue(Context& working) : working_(working) {}

    void post(Task task, bool cuts_short) {
        const std::lock_guard lock(mutex_);
        tasks_.push_back(std::move(task));
        if (cuts_short)
            working_.cancel();
        arrived_.notify_one();
    }

    /// All tasks that wait, in order; where there is none, waits for one if asked to. What comes after this call may
    /// cut short what comes after it.
    std::vector<Task> take(bool wait) {
        std::unique_lock lock(mutex_);
        if (wait)
            arrived_.wait(lock, [&] { return closed_ || !tasks_.empty(); });
        if (!closed_)
            working_.resume();
        return std::exchange(tasks_, {});
    }

    /// Ends all waiting, and cuts short what is being worked at.
    void close() {
        const std::lock_guard lock(mutex_);
        closed_ = true;
        working_.cancel();
        arrived_.notify_all();
    }
    bool is_closed() {
        const std::lock_guard lock(mutex_);
        return closed_;
    }

private:
    Context& working_;
    std::mutex mutex_;
    std::condition_variable arrived_;
    std::vector<Task> tasks_;
    bool closed_ = false;
};

} // namespace plisse::studio
