#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace plisse {

/// Something done to a run between two of its steps.
struct Edit {
    enum class Kind {
        set,    ///< a value of the scene is changed
        refine, ///< the state is refined to the next level, and the run goes on there
        end     ///< the run ends
    };
    Kind kind = Kind::set;
    int level = 0;       ///< of the run at that moment
    int step = 0;        ///< steps taken on that level before
    std::string pointer; ///< set: JSON pointer into the scene
    nlohmann::ordered_json value;
};

/// Edits in the order in which they are made. A run of the scene that makes them is the same in every bit.
using EditLog = std::vector<std::shared_ptr<const Edit>>;

/// Reads an edit log: {"plisse-edits": 1, "edits": [{"level": 0, "step": 12, "set": "/gravity", "value": [0, -5, 0]},
/// {"level": 0, "step": 40, "refine": true}, {"level": 1, "step": 7, "end": true}]}. Throws InputError naming file and
/// place for anything else, and for edits out of order.
EditLog read_edit_log(const std::filesystem::path& path);

/// The text of such a file, one edit a line.
std::string edit_log_text(const EditLog& log);

} // namespace plisse
