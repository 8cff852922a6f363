#include <studio/commands.h>

#include <gtest/gtest.h>

#include <plisse/base/random.h>

namespace plisse::studio {
namespace {

using nlohmann::json;

template <typename Expected>
Expected expect_command(const std::string& text) {
    const auto parsed = parse_command(text);
    const Command* command = std::get_if<Command>(&parsed);
    EXPECT_TRUE(command) << text << ": " << std::get<NotACommand>(parsed).message;
    if (!command)
        return {};
    EXPECT_TRUE(std::holds_alternative<Expected>(*command)) << text;
    return std::holds_alternative<Expected>(*command) ? std::get<Expected>(*command) : Expected{};
}

NotACommand expect_refused(const std::string& text) {
    const auto parsed = parse_command(text);
    EXPECT_TRUE(std::holds_alternative<NotACommand>(parsed)) << text.substr(0, 200);
    return std::holds_alternative<NotACommand>(parsed) ? std::get<NotACommand>(parsed) : NotACommand{};
}

const std::vector<std::string> good_messages = {
    R"({"type": "open", "gallery": "drape"})",
    R"({"type": "play"})",
    R"({"type": "pause"})",
    R"({"type": "step"})",
    R"({"type": "set", "edits": [{"set": "/bodies/0/pressure", "value": 120}], "gesture": "g7"})",
    R"({"type": "set", "edits": [{"set": "/a~0b~1c", "value": null}, {"set": "/gravity", "value": [0, -9.81, 0]}]})",
    R"({"type": "grab", "id": "g8", "vertex": 17, "to": [0.5, -1, 2e-3]})",
    R"({"type": "release", "id": "g8"})",
    R"({"type": "pin", "id": "g8"})",
    R"({"type": "undo"})",
    R"({"type": "redo"})",
    R"({"type": "refine", "to": "next"})",
    R"({"type": "refine", "to": "finest"})",
    R"({"type": "stop"})",
    R"({"type": "preview"})",
    R"({"type": "restart"})",
    R"({"type": "show", "detail": true, "color": "curvature"})",
    R"({"type": "frame", "index": 12})",
    R"({"type": "frame", "index": null})",
    R"({"type": "save", "name": "drape"})",
    R"({"type": "export", "format": "gltf", "what": "animation"})",
};

TEST(Commands, EveryMessageOfTheProtocolIsRead) {
    EXPECT_EQ(expect_command<OpenScene>(good_messages[0]).gallery, "drape");
    expect_command<Play>(good_messages[1]);
    expect_command<Pause>(good_messages[2]);
    expect_command<Step>(good_messages[3]);
    const SetValues set = expect_command<SetValues>(good_messages[4]);
    ASSERT_EQ(set.edits.size(), 1U);
    EXPECT_EQ(set.edits[0].pointer, "/bodies/0/pressure");
    EXPECT_EQ(set.edits[0].value, 120);
    EXPECT_EQ(set.gesture, "g7");
    EXPECT_EQ(expect_command<SetValues>(good_messages[5]).edits[1].value, json({0, -9.81, 0}));
    EXPECT_EQ(expect_command<SetValues>(good_messages[5]).gesture, "");
    const Grab grab = expect_command<Grab>(good_messages[6]);
    EXPECT_EQ(grab.id, "g8");
    EXPECT_EQ(grab.vertex, 17);
    EXPECT_EQ(grab.to, Vec3(0.5, -1, 2e-3));
    EXPECT_EQ(expect_command<Release>(good_messages[7]).id, "g8");
    EXPECT_EQ(expect_command<Pin>(good_messages[8]).id, "g8");
    expect_command<Undo>(good_messages[9]);
    expect_command<Redo>(good_messages[10]);
    EXPECT_FALSE(expect_command<Refine>(good_messages[11]).to_finest);
    EXPECT_TRUE(expect_command<Refine>(good_messages[12]).to_finest);
    expect_command<Stop>(good_messages[13]);
    expect_command<Preview>(good_messages[14]);
    expect_command<Restart>(good_messages[15]);
    const Show show = expect_command<Show>(good_messages[16]);
    EXPECT_TRUE(show.detail);
    EXPECT_EQ(show.color, ShownColor::curvature);
    EXPECT_EQ(expect_command<ShowFrame>(good_messages[17]).index, 12);
    EXPECT_EQ(expect_command<ShowFrame>(good_messages[18]).index, std::nullopt);
    EXPECT_EQ(expect_command<Save>(good_messages[19]).name, "drape");
    const Export animation = expect_command<Export>(good_messages[20]);
    EXPECT_EQ(animation.format, AnimationFormat::gltf);
    EXPECT_TRUE(animation.animation);
    EXPECT_FALSE(expect_command<Export>(R"({"type": "export", "format": "pc2", "what": "state"})").animation);
}

TEST(Commands, WhatIsWrongIsSaid) {
    const auto expect_message = [](const std::string& text, const std::string& message, const std::string& type) {
        const NotACommand refused = expect_refused(text);
        EXPECT_EQ(refused.message, message);
        EXPECT_EQ(refused.in_answer_to, type);
    };
    expect_message("", "the message is not JSON", "");
    expect_message("[]", "the message must be an object", "");
    expect_message("{}", "the message needs \"type\"", "");
    expect_message(R"({"type": 1})", "the field \"type\" of the message must be a string", "");
    expect_message(R"({"type": "dance"})", "there is no message of type \"dance\"", "dance");
    expect_message(R"({"type": "play", "speed": 2})", "the message has no field \"speed\"", "play");
    expect_message(R"({"type": "open"})", "the message needs \"gallery\"", "open");
    expect_message(R"({"type": "show", "detail": 1, "color": "none"})",
                   "the field \"detail\" of the message must be true or false", "show");
    expect_message(R"({"type": "refine", "to": "all"})", "the field \"to\" of the message must be one of next, finest",
                   "refine");
    expect_message(R"({"type": "set", "edits": [{"set": "pressure", "value": 1}]})",
                   "\"pressure\" is no JSON pointer; one reads like /bodies/0/pressure", "set");
}

TEST(Commands, ValuesOutOfTheirRangeAreRefused) {
    for (const char* text : {
             R"({"type": "grab", "id": "g", "vertex": -1, "to": [0, 0, 0]})",
             R"({"type": "grab", "id": "g", "vertex": 1.5, "to": [0, 0, 0]})",
             R"({"type": "grab", "id": "g", "vertex": 2147483648, "to": [0, 0, 0]})",
             R"({"type": "grab", "id": "g", "vertex": 1e30, "to": [0, 0, 0]})",
             R"({"type": "grab", "id": "g", "vertex": 1, "to": [0, 0]})",
             R"({"type": "grab", "id": "g", "vertex": 1, "to": [0, 0, null]})",
             R"({"type": "grab", "id": "g", "vertex": 1, "to": [0, 0, 1e300]})",
             R"({"type": "grab", "id": "g", "vertex": 1, "to": [0, 0, 1e999]})",
             R"({"type": "grab", "id": "g", "vertex": 1, "to": [0, 0, NaN]})",
             R"({"type": "frame", "index": -1})",
             R"({"type": "frame"})",
             R"({"type": "save", "name": "../drape"})",
             R"({"type": "save", "name": ""})",
             R"({"type": "save", "name": "a\u0000b"})",
             R"({"type": "open", "gallery": "/etc/passwd"})",
             R"({"type": "set", "edits": []})",
             R"({"type": "set", "edits": {}})",
             R"({"type": "set", "edits": [1]})",
             R"({"type": "set", "edits": [{"set": "/a"}]})",
             R"({"type": "set", "edits": [{"value": 1}]})",
             R"({"type": "set", "edits": [{"set": "", "value": 1}]})",
             R"({"type": "set", "edits": [{"set": "/a~2", "value": 1}]})",
             R"({"type": "set", "edits": [{"set": "/a~", "value": 1}]})",
             R"({"type": "set", "edits": [{"set": "/a", "value": 1, "more": 2}]})",
             R"({"type": "export", "format": "fbx"})",
             R"({"type": "play"} x)",
             "{\"type\": \"\xFF\"}",
         })
        EXPECT_FALSE(expect_refused(text).message.empty()) << text;
}

TEST(Commands, DeepNestingIsRefusedAtAnyDepth) {
    const std::string start = R"({"type": "set", "edits": [{"set": "/a", "value": )";
    const auto nested = [&](std::size_t depth) {
        return start + std::string(depth, '[') + std::string(depth, ']') + "}]}";
    };
    expect_command<SetValues>(nested(50));
    EXPECT_NE(expect_refused(nested(100)).message.find("nested"), std::string::npos);
    EXPECT_NE(expect_refused(nested(500'000)).message.find("nested"), std::string::npos);
    expect_refused(std::string(1'000'000, '['));
}

TEST(Commands, LongNamesMakeNoLongSentences) {
    std::string long_name;
    for (int i = 0; i < 10'000; ++i)
        long_name += "\xC3\xA9";
    for (const std::string& prefix : {std::string(), std::string("x")}) {
        const NotACommand refused = expect_refused(R"({"type": ")" + prefix + long_name + "\"}");
        EXPECT_LT(refused.message.size(), 200U);
        EXPECT_EQ(refused.in_answer_to, "");
        // Would not parse if a character had been cut in two.
        EXPECT_EQ(json::parse(error_message(refused))["message"], refused.message);
        EXPECT_EQ(json(refused.message).dump().find("\\ufffd"), std::string::npos);
    }
}

TEST(Commands, ErrorsAreMessagesOfTheProtocol) {
    const json expected = {{"type", "error"}, {"message", "no \"such\" thing"}, {"in_answer_to", "open"}};
    EXPECT_EQ(json::parse(error_message({"no \"such\" thing", "open"})), expected);
    EXPECT_NO_THROW(error_message({"\xFF", "\xFF"}));
}

TEST(Commands, PlainNamesNameFilesOfTheSession) {
    for (const char* name : {"a", "drape.json", "Drape-2_b", "0", "_", "a..b"})
        EXPECT_TRUE(is_plain_name(name)) << name;
    for (const char* name : {"", ".", "..", ".hidden", "-rf", "a/b", "a\\b", "a b", "a:b", "\xC3\xA9", "a\n"})
        EXPECT_FALSE(is_plain_name(name)) << name;
    EXPECT_TRUE(is_plain_name(std::string(64, 'a')));
    EXPECT_FALSE(is_plain_name(std::string(65, 'a')));
    EXPECT_FALSE(is_plain_name(std::string_view("a\0b", 3)));
}

std::string mutated(std::string text, Random& random) {
    static const std::vector<std::string> pieces = {"{",    "}",    "[",    "]",         "\"", ",",
                                                    ":",    "null", "-1",   "1e99",      "\\", "\\u0000",
                                                    "\xFF", "/",    "true", "\"type\":", "~",  " "};
    const int changes = 1 + random.below(3);
    for (int i = 0; i < changes; ++i) {
        const int place = random.below(static_cast<int>(text.size()) + 1);
        const std::string& piece = pieces[static_cast<std::size_t>(random.below(static_cast<int>(pieces.size())))];
        switch (random.below(4)) {
        case 0:
            text.insert(static_cast<std::size_t>(place), piece);
            break;
        case 1:
            text.erase(static_cast<std::size_t>(place), static_cast<std::size_t>(1 + random.below(8)));
            break;
        case 2:
            text.resize(static_cast<std::size_t>(place));
            break;
        default:
            if (place < static_cast<int>(text.size()))
                text[static_cast<std::size_t>(place)] = static_cast<char>(random.below(256));
        }
    }
    return text;
}

TEST(Commands, MutationsAreReadOrAnswered) {
    Random random(6);
    int read = 0, refused = 0;
    for (int round = 0; round < 20'000; ++round) {
        const auto which = static_cast<std::size_t>(random.below(static_cast<int>(good_messages.size())));
        const auto parsed = parse_command(mutated(good_messages[which], random));
        if (const auto* refusal = std::get_if<NotACommand>(&parsed)) {
            ++refused;
            EXPECT_FALSE(refusal->message.empty());
            EXPECT_EQ(json::parse(error_message(*refusal))["type"], "error");
        } else {
            ++read;
        }
    }
    EXPECT_GT(read, 200);
    EXPECT_GT(refused, 10'000);
}

} // namespace
} // namespace plisse::studio
