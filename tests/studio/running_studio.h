#pragma once

#include <string>
#include <thread>

#include <nlohmann/json.hpp>

#include <studio/studio.h>

#include "raw_client.h"
#include "scene/temporary_folder.h"

namespace plisse::studio {

/// A cloth of some 300 vertices on a ball, on two levels; a frame is saved of every step.
extern const char* const small_scene_text;

/// A studio and its server, each on a thread of its own, with a folder that vanishes at the end.
class RunningStudio {
public:
    /// scene: its text, opened at once; null: none. folder: the session's; null: a fresh one.
    explicit RunningStudio(const char* scene = small_scene_text, const std::filesystem::path* folder = nullptr,
                           ServerOptions options = {});
    ~RunningStudio() { stop(); }
    RunningStudio(const RunningStudio&) = delete;
    RunningStudio& operator=(const RunningStudio&) = delete;

    void stop();
    std::uint16_t port() const { return server.port(); }
    /// Whether it still answers both kinds of request.
    bool is_well();
    RawResponse get(const std::string& target);
    RawResponse post(const std::string& target, const std::string& body);

private:
    TemporaryFolder own_folder_;

public:
    const std::filesystem::path folder; ///< the session's
    const std::string token = random_token();
    Studio studio;
    Server server;

private:
    std::thread thread_;
};

/// What a page of the studio sees, as it comes.
class WatchingPage {
public:
    explicit WatchingPage(const RunningStudio& running);

    bool is_open() const { return page.is_open(); }
    void send(const nlohmann::json& message) { page.send_text(message.dump()); }
    /// The next text for which this holds; null at the end of patience.
    template <typename Holds>
    nlohmann::json next_where(Holds holds) {
        for (;;) {
            const auto frame = page.frame();
            if (!frame)
                return {};
            if (frame->opcode == binary_frame) {
                keep(frame->payload);
                continue;
            }
            nlohmann::json json = nlohmann::json::parse(frame->payload);
            if (json.at("type") == "status")
                status = json;
            if (holds(json))
                return json;
        }
    }
    nlohmann::json next(const std::string& type) {
        return next_where([&](const nlohmann::json& json) { return json.at("type") == type; });
    }
    /// Waits for a status with this state.
    bool comes_to(const std::string& state) {
        return !next_where([&](const nlohmann::json& json) {
                    return json.at("type") == "status" && json.at("state") == state;
                }).is_null();
    }

    RawPage page;
    nlohmann::json status;           ///< the last
    std::vector<std::string> states; ///< the messages of positions that have come, as they came

private:
    void keep(const std::string& bytes);
};

} // namespace plisse::studio
