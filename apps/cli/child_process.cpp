#include "child_process.h"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <system_error>

#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fmt/format.h>

#include <plisse/scene/report_json.h>

namespace plisse {

namespace {

using Json = nlohmann::ordered_json;

void write_all(int pipe, std::string_view text) {
    while (!text.empty()) {
        const ssize_t written = write(pipe, text.data(), text.size());
        if (written <= 0)
            return;
        text.remove_prefix(static_cast<std::size_t>(written));
    }
}

[[noreturn]] void be_the_child(const std::function<Json()>& work, int pipe) {
    Json result;
    try {
        result = work();
        result["peak_memory_bytes"] = peak_memory_bytes();
    } catch (const std::exception& error) {
        result = {{"error", error.what()}};
    }
    write_all(pipe, result.dump());
    _exit(0); // nothing of the parent's is flushed or destroyed twice
}

/// All that comes through the pipe until its other end closes.
std::string read_all(int pipe, pid_t child, const Context& context) {
    constexpr int wait_ms = 200;
    std::string text;
    std::array<char, 4096> buffer;
    for (bool told = false;;) {
        if (context.cancelled() && !told) {
            told = true;
            kill(child, SIGINT);
        }
        pollfd ready{pipe, POLLIN, 0};
        if (poll(&ready, 1, wait_ms) <= 0)
            continue; // nothing yet, or a signal
        const ssize_t count = read(pipe, buffer.data(), buffer.size());
        if (count < 0 && errno == EINTR)
            continue;
        if (count <= 0)
            return text;
        text.append(buffer.data(), static_cast<std::size_t>(count));
    }
}

} // namespace

Json in_child_process(const std::function<Json()>& work, const Context& context) {
    std::array<int, 2> ends{};
    if (pipe(ends.data()) != 0)
        throw std::system_error(errno, std::generic_category(), "cannot make a pipe");
    std::fflush(nullptr);
    const pid_t child = fork();
    if (child < 0)
        throw std::system_error(errno, std::generic_category(), "cannot start a process");
    if (child == 0) {
        close(ends[0]);
        be_the_child(work, ends[1]);
    }
    close(ends[1]);
    const std::string text = read_all(ends[0], child, context);
    close(ends[0]);
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    if (WIFSIGNALED(status))
        return {{"error", fmt::format("its process was ended by signal {}", WTERMSIG(status))}};
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0 || text.empty())
        return {{"error", "its process came to no end"}};
    return Json::parse(text);
}

} // namespace plisse
