#include <plisse/scene/checkpoint_folder.h>

#include <algorithm>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <plisse/scene/json_document.h>
#include <plisse/scene/report_json.h>
#include <plisse/scene/whole_file.h>

namespace plisse {

namespace {

using Json = nlohmann::ordered_json;

std::string state_file_name(int number) {
    return fmt::format("state-{}.bin", number);
}

std::string_view bytes_of(const Positions& x) {
    return {reinterpret_cast<const char*>(x.data()), static_cast<std::size_t>(x.size()) * sizeof(double)};
}

Json manifest_json(const SavedCheckpoint& saved, int state, const std::string& hash) {
    const Checkpoint& c = saved.checkpoint;
    return {{"format", 1},
            {"state", state},
            {"fnv1a64", hash},
            {"vertices", c.positions.cols()},
            {"velocities", c.velocity.cols()},
            {"level", c.level},
            {"step", c.step},
            {"settle_step", c.settle_step},
            {"settle_time_step", c.settle_time_step},
            {"settle_tolerance", c.settle_tolerance},
            {"settled", c.settled},
            {"t", c.t},
            {"frame_numbers", c.frame_numbers},
            {"log_bytes", saved.log_bytes},
            {"index_bytes", saved.index_bytes},
            {"report", report_to_json(c.report, {})}};
}

SavedCheckpoint from_manifest(const Json& json) {
    SavedCheckpoint saved;
    Checkpoint& c = saved.checkpoint;
    json.at("level").get_to(c.level);
    json.at("step").get_to(c.step);
    json.at("settle_step").get_to(c.settle_step);
    json.at("settle_time_step").get_to(c.settle_time_step);
    json.at("settle_tolerance").get_to(c.settle_tolerance);
    json.at("settled").get_to(c.settled);
    json.at("t").get_to(c.t);
    json.at("frame_numbers").get_to(c.frame_numbers);
    json.at("log_bytes").get_to(saved.log_bytes);
    json.at("index_bytes").get_to(saved.index_bytes);
    c.report = report_from_json(json.at("report"));
    c.positions.resize(3, json.at("vertices").get<int>());
    c.velocity.resize(3, json.at("velocities").get<int>());
    return saved;
}

/// Fills positions and velocities, whose sizes are set; false when the bytes are not as many.
bool fill_state(std::string_view bytes, Checkpoint& checkpoint) {
    const std::size_t positions = bytes_of(checkpoint.positions).size();
    const std::size_t velocities = bytes_of(checkpoint.velocity).size();
    if (bytes.size() != positions + velocities)
        return false;
    const auto fill = [](Positions& target, std::string_view source) { // there may be nothing to copy, and nowhere
        std::copy(source.begin(), source.end(), reinterpret_cast<char*>(target.data()));
    };
    fill(checkpoint.positions, bytes.substr(0, positions));
    fill(checkpoint.velocity, bytes.substr(positions));
    return true;
}

} // namespace

void CheckpointFolder::save(const SavedCheckpoint& saved) {
    const int state = 1 - state_in_use_;
    std::string bytes(bytes_of(saved.checkpoint.positions));
    bytes += bytes_of(saved.checkpoint.velocity);
    write_file_atomically(folder_ / state_file_name(state), bytes);
    write_file_atomically(folder_ / "manifest.json", manifest_json(saved, state, fnv1a64(bytes)).dump());
    state_in_use_ = state;
}

std::optional<SavedCheckpoint> CheckpointFolder::load() {
    const std::filesystem::path manifest = folder_ / "manifest.json";
    if (!std::filesystem::exists(manifest))
        return std::nullopt;
    const InputError damaged(manifest.string(), "the checkpoint is damaged",
                             "begin again with --overwrite instead of --resume");
    try {
        const Json json = Json::parse(read_bytes(manifest));
        SavedCheckpoint saved = from_manifest(json);
        const int state = json.at("state").get<int>();
        const std::string bytes = read_bytes(folder_ / state_file_name(state));
        if (json.at("fnv1a64") != fnv1a64(bytes) || !fill_state(bytes, saved.checkpoint))
            throw damaged;
        state_in_use_ = state;
        return saved;
    } catch (const Json::exception&) {
        throw damaged;
    }
}

} // namespace plisse
