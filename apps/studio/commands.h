#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <nlohmann/json.hpp>

#include <plisse/base/types.h>
#include <plisse/exports/formats.h>

namespace plisse::studio {

/// One of the two is given, the other empty.
struct OpenScene {
    std::string gallery; ///< id of a scene of the gallery, a plain name
    std::string file;    ///< a scene that the session has saved, a plain name
};
struct Play {};
struct Pause {};
struct Step {};

/// Sets one value of the scene.
struct SceneEdit {
    std::string pointer; ///< JSON pointer, well-formed, not empty
    nlohmann::json value;
};
struct SetValues {
    std::vector<SceneEdit> edits; ///< at least one
    std::string gesture;          ///< empty: none
};

struct Grab {
    std::string id; ///< of the pull
    int vertex = 0; ///< of the level shown; at least 0
    Vec3 to;        ///< m, finite
};
struct Release {
    std::string id;
};
struct Pin {
    std::string id;
};
struct Undo {};
struct Redo {};
struct Refine {
    bool to_finest = false; ///< else to the next level
};
struct Stop {};
struct Preview {};
struct Restart {};

enum class ShownColor { none, stretch, curvature, gap, level };
struct Show {
    bool detail = false; ///< on the finest mesh, by prolongation alone
    ShownColor color = ShownColor::none;
};
struct ShowFrame {
    std::optional<int> index; ///< at least 0; none: the running state
};
struct Save {
    std::string name; ///< a plain name
};

struct Export {
    AnimationFormat format = AnimationFormat::obj;
    bool animation = true; ///< else the state alone
};

/// What a page can ask for.
using Command = std::variant<OpenScene, Play, Pause, Step, SetValues, Grab, Release, Pin, Undo, Redo, Refine, Stop,
                             Preview, Restart, Show, ShowFrame, Save, Export>;

/// Why a message is no command.
struct NotACommand {
    std::string message;      ///< a sentence for the user, valid UTF-8
    std::string in_answer_to; ///< the message's type as it was written; empty where it has none
};

/// Reads a text message of the page. Every field is checked, unknown ones are refused. Throws nothing but bad_alloc.
std::variant<Command, NotACommand> parse_command(std::string_view text);

/// {"type": "error", "message": ..., "in_answer_to": ...}
std::string error_message(const NotACommand& refused);

/// Whether `name` can name a file of the session: 1 to 64 of A-Z a-z 0-9 . _ -, not beginning with a dot or a hyphen.
bool is_plain_name(std::string_view name);

} // namespace plisse::studio
