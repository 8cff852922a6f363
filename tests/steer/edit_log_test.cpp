#include <gtest/gtest.h>

#include <plisse/base/error.h>
#include <plisse/steer/edit_log.h>

#include "scene/temporary_folder.h"

using namespace plisse;

namespace {

EditLog read(const std::string& text) {
    const TemporaryFolder folder;
    write_text(folder.path() / "log.json", text);
    return read_edit_log(folder.path() / "log.json");
}

EditLog read_edits(const std::string& edits) {
    return read("{\"plisse-edits\": 1, \"edits\": [" + edits + "]}");
}

TEST(EditLog, IsReadAsItWasWritten) {
    const EditLog log = read_edits(R"({"level": 0, "step": 3, "set": "/gravity", "value": [0, -0.1, 1e-17]},
        {"level": 0, "step": 3, "set": "/pulls", "value": [{"name": "a", "points": [], "x": null, "y": true}]},
        {"level": 0, "step": 9, "refine": true}, {"level": 1, "step": 2, "end": true, "x-note": "mine"})");
    ASSERT_EQ(log.size(), 4u);
    EXPECT_EQ(log[0]->pointer, "/gravity");
    EXPECT_EQ(log[0]->value[2], 1e-17);
    EXPECT_EQ(log[2]->kind, Edit::Kind::refine);
    EXPECT_EQ(log[3]->kind, Edit::Kind::end);
    EXPECT_EQ(log[3]->step, 2);
    const EditLog again = read(edit_log_text(log));
    ASSERT_EQ(again.size(), 4u);
    EXPECT_EQ(edit_log_text(again), edit_log_text(log));
    EXPECT_EQ(again[1]->value, log[1]->value);
}

TEST(EditLog, RefusesWhatIsNoneAndSaysWhere) {
    for (const char* edits :
         {R"({"level": 0, "step": 3})", R"({"level": 0, "step": 3, "set": "/gravity"})",
          R"({"level": 0, "step": -1, "end": true})", R"({"level": 0, "set": "/gravity", "value": 1})",
          R"({"level": 0, "step": 3, "refine": false})", R"({"level": 0, "step": 1, "end": true, "stop": 1})",
          R"({"level": 0, "step": 3, "set": "/a", "value": 1}, {"level": 0, "step": 2, "end": true})",
          R"({"level": 0, "step": 3, "end": true}, {"level": 0, "step": 4, "end": true})",
          R"({"level": 0, "step": 3, "refine": true}, {"level": 0, "step": 4, "end": true})",
          R"({"level": 1, "step": 0, "end": true})", "7"}) {
        try {
            read_edits(edits);
            FAIL() << edits;
        } catch (const InputError& error) {
            EXPECT_NE(std::string(error.what()).find("/edits/"), std::string::npos) << error.what();
        }
    }
    EXPECT_THROW(read("{\"plisse-edits\": 2, \"edits\": []}"), InputError);
    EXPECT_THROW(read("{\"plisse-edits\": 1}"), InputError);
    EXPECT_THROW(read("[]"), InputError);
    EXPECT_THROW(read_edit_log("/nowhere/log.json"), InputError);
}

} // namespace
