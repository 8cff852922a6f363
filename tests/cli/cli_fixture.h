#pragma once

#include <filesystem>
#include <regex>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "program.h"
#include "scene/temporary_folder.h"

namespace plisse {

using Json = nlohmann::json;
namespace fs = std::filesystem;

/// Runs the program in a folder of its own.
class Cli : public testing::Test {
protected:
    Outcome run(const std::vector<std::string>& arguments) { return Program(folder_.path(), arguments).wait(); }
    std::string at(const std::string& file) const { return (folder_.path() / file).string(); }
    void write(const std::string& file, const std::string& text) { write_text(folder_.path() / file, text); }
    Json json_of(const std::string& file) { return Json::parse(read_text(folder_.path() / file)); }

    void expect_unusable(const std::vector<std::string>& arguments, const std::string& fragment) {
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.code, 2) << outcome.err;
        EXPECT_TRUE(std::regex_match(outcome.err, std::regex("plisse: error: [^\n]+: [^\n]+; [^\n]+\n")))
            << outcome.err;
        EXPECT_NE(outcome.err.find(fragment), std::string::npos) << outcome.err;
    }

    TemporaryFolder folder_;
};

} // namespace plisse
