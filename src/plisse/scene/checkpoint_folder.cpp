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

constexpr int format = 4;

std::string state_file_name(int number) {
    return fmt::format("state-{}.bin", number);
}

/// The arrays of a checkpoint's state, as its file holds them one after another.
struct State {
    Positions positions, velocity, friction_reference, elastic_slip;
    Eigen::Matrix<int, 3, Eigen::Dynamic> rubbing; ///< kind and primitives
    std::vector<Positions> previews;

    template <typename Visit>
    void for_each(const Visit& visit) {
        visit(positions);
        visit(velocity);
        visit(friction_reference);
        visit(elastic_slip);
        visit(rubbing);
        for (Positions& preview : previews)
            visit(preview);
    }
};

State state_of(const Checkpoint& c) {
    State state{c.positions, c.velocity, c.friction.reference, {}, {}, c.previews};
    const auto pairs = static_cast<Eigen::Index>(c.friction.pairs.size());
    state.elastic_slip.resize(3, pairs);
    state.rubbing.resize(3, pairs);
    for (Eigen::Index p = 0; p < pairs; ++p) {
        const RubbingPair& pair = c.friction.pairs[static_cast<std::size_t>(p)];
        state.elastic_slip.col(p) = pair.elastic_slip;
        state.rubbing.col(p) << static_cast<int>(pair.kind), pair.primitives[0], pair.primitives[1];
    }
    return state;
}

void restore(State state, Checkpoint& c) {
    for (Eigen::Index p = 0; p < state.rubbing.cols(); ++p)
        c.friction.pairs.push_back({static_cast<StencilKind>(state.rubbing(0, p)),
                                    {state.rubbing(1, p), state.rubbing(2, p)},
                                    state.elastic_slip.col(p)});
    c.positions = std::move(state.positions);
    c.velocity = std::move(state.velocity);
    c.friction.reference = std::move(state.friction_reference);
    c.previews = std::move(state.previews);
}

std::string bytes_of(State state) {
    std::string bytes;
    state.for_each([&](const auto& array) {
        if (array.size() > 0)
            bytes.append(reinterpret_cast<const char*>(array.data()),
                         static_cast<std::size_t>(array.size()) * sizeof(*array.data()));
    });
    return bytes;
}

/// Arrays of the sizes that the manifest says, filled in turn. Nothing when the bytes are not as many.
std::optional<State> state_from(std::string_view bytes, const Json& manifest) {
    State state;
    state.positions.resize(3, manifest.at("vertices").get<int>());
    state.velocity.resize(3, manifest.at("velocities").get<int>());
    state.friction_reference.resize(3, manifest.at("friction_references").get<int>());
    state.elastic_slip.resize(3, manifest.at("rubbing_pairs").get<int>());
    state.rubbing.resize(3, state.elastic_slip.cols());
    for (const Json& vertices : manifest.at("preview_vertices"))
        state.previews.emplace_back(3, vertices.get<int>());
    bool complete = true;
    state.for_each([&](auto& array) {
        const std::size_t size = static_cast<std::size_t>(array.size()) * sizeof(*array.data());
        complete = complete && size <= bytes.size();
        if (!complete || size == 0) // there may be nothing to copy, and nowhere
            return;
        std::copy_n(bytes.begin(), size, reinterpret_cast<char*>(array.data()));
        bytes.remove_prefix(size);
    });
    return complete && bytes.empty() ? std::optional(std::move(state)) : std::nullopt;
}

Json manifest_json(const SavedCheckpoint& saved, int state, const std::string& hash) {
    const Checkpoint& c = saved.checkpoint;
    Json preview_vertices = Json::array();
    for (const Positions& preview : c.previews)
        preview_vertices.push_back(preview.cols());
    return {{"format", format},
            {"state", state},
            {"fnv1a64", hash},
            {"vertices", c.positions.cols()},
            {"velocities", c.velocity.cols()},
            {"friction_references", c.friction.reference.cols()},
            {"rubbing_pairs", c.friction.pairs.size()},
            {"preview_vertices", preview_vertices},
            {"level", c.level},
            {"step", c.step},
            {"settle_step", c.settle_step},
            {"settle_time_step", c.settle_time_step},
            {"settle_tolerance", c.settle_tolerance},
            {"stiffness_factor", c.stiffness_factor},
            {"stiffening_helps", c.stiffening_helps},
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
    json.at("stiffness_factor").get_to(c.stiffness_factor);
    json.at("stiffening_helps").get_to(c.stiffening_helps);
    json.at("settled").get_to(c.settled);
    json.at("t").get_to(c.t);
    json.at("frame_numbers").get_to(c.frame_numbers);
    json.at("log_bytes").get_to(saved.log_bytes);
    json.at("index_bytes").get_to(saved.index_bytes);
    c.report = report_from_json(json.at("report"));
    return saved;
}

} // namespace

void CheckpointFolder::save(const SavedCheckpoint& saved) {
    const int state = 1 - state_in_use_;
    const std::string bytes = bytes_of(state_of(saved.checkpoint));
    write_file_atomically(folder_ / state_file_name(state), bytes);
    write_file_atomically(folder_ / "manifest.json", manifest_json(saved, state, fnv1a64(bytes)).dump());
    state_in_use_ = state;
}

std::optional<SavedCheckpoint> CheckpointFolder::load() {
    const std::filesystem::path manifest = folder_ / "manifest.json";
    if (!std::filesystem::exists(manifest))
        return std::nullopt;
    const std::string way_out = "begin again with --overwrite instead of --resume";
    const InputError damaged(manifest.string(), "the checkpoint is damaged", way_out);
    try {
        const Json json = Json::parse(read_bytes(manifest));
        if (json.at("format") != format)
            throw InputError(manifest.string(), "the checkpoint is of another version of plisse", way_out);
        SavedCheckpoint saved = from_manifest(json);
        const int state = json.at("state").get<int>();
        const std::string bytes = read_bytes(folder_ / state_file_name(state));
        std::optional<State> arrays = state_from(bytes, json);
        if (json.at("fnv1a64") != fnv1a64(bytes) || !arrays)
            throw damaged;
        restore(*std::move(arrays), saved.checkpoint);
        state_in_use_ = state;
        return saved;
    } catch (const Json::exception&) {
        throw damaged;
    }
}

} // namespace plisse
