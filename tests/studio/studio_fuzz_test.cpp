#include <studio/server.h>

#include <array>
#include <fstream>
#include <map>

#include <gtest/gtest.h>
#include <unistd.h>

#include <plisse/base/random.h>
#include <studio/commands.h>

#include "raw_client.h"
#include "running_server.h"
#include "running_studio.h"

namespace plisse::studio {
namespace {

std::string random_bytes(Random& random, int most) {
    std::string bytes(static_cast<std::size_t>(1 + random.below(most)), '\0');
    for (char& byte : bytes)
        byte = static_cast<char>(random.below(256));
    return bytes;
}

/// A masked frame whose header claims this length, whatever follows.
std::string frame_claiming(std::uint64_t length, std::string_view payload) {
    std::string frame = "\x81\xFF";
    for (int shift = 56; shift >= 0; shift -= 8)
        frame += static_cast<char>(length >> shift);
    return frame.append("mask").append(payload);
}

constexpr std::size_t message_bytes = 4096;

/// Frames that no correct page sends; the server closes the connection for each, or waits for more of it.
std::string malformed_frames(Random& random) {
    const std::string payload = random_bytes(random, 100);
    switch (random.below(12)) {
    case 0:
        return random_bytes(random, 300);
    case 1: { // cut short
        const std::string whole = client_frame(text_frame, payload);
        return whole.substr(0, static_cast<std::size_t>(1 + random.below(static_cast<int>(whole.size()) - 1)));
    }
    case 2: { // no such opcode
        const int opcode = 3 + random.below(10);
        return client_frame(opcode < 8 ? opcode : opcode + 3, payload);
    }
    case 3: // not masked
        return std::string("\x81") + static_cast<char>(payload.size()) + payload;
    case 4: // lengths up to 2^64 - 1
        return frame_claiming(random.bits() >> random.below(52), payload);
    case 5: { // reserved bits
        std::string frame = client_frame(text_frame, payload);
        frame[0] = static_cast<char>(frame[0] | ((1 + random.below(7)) << 4));
        return frame;
    }
    case 6: // control frames in pieces, and too long
        return random.below(2) ? client_frame(ping_frame, payload, false)
                               : client_frame(ping_frame, std::string(126, 'p'));
    case 7: // pieces without a beginning; a beginning within pieces
        return random.below(2) ? client_frame(0, payload)
                               : client_frame(text_frame, "a", false) + client_frame(text_frame, "b");
    case 8: // no UTF-8
        return client_frame(text_frame, "\"" + payload + "\xFE");
    case 9:
        return client_frame(binary_frame, payload);
    case 10: // a good-bye of one byte, or with a code that is none
        return client_frame(close_frame, random.below(2) ? std::string("\x03") : std::string("\x03\xEC") + payload);
    default: { // too much, in pieces
        std::string pieces = client_frame(text_frame, "", false);
        while (pieces.size() < 2 * message_bytes)
            pieces += client_frame(0, std::string(500, 'x'), false);
        return pieces;
    }
    }
}

/// Valid UTF-8 that is no command, or hardly one.
std::string malformed_text(Random& random) {
    static const std::array pieces = {"{",       "}",  "[",        "]",    "\"type\":",
                                      "\"set\"", ",",  "1e999",    "null", "\"edits\":",
                                      "\\",      "\"", "\xC3\xA9", "-",    "{\"type\": \"play\"}",
                                      "\\u0000", ":",  "true"};
    std::string text;
    for (int i = random.below(30); i >= 0; --i)
        text += pieces[static_cast<std::size_t>(random.below(static_cast<int>(pieces.size())))];
    return text;
}

std::size_t resident_bytes() {
    std::size_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages >> pages;
    return pages * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
}

void expect_no_growth(std::size_t before) {
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__) // they keep what was freed
    EXPECT_LT(resident_bytes(), before + (std::size_t{8} << 20));
#else
    (void)before;
#endif
}

TEST(StudioFuzz, MalformedMessagesAreAnsweredOrEndTheirConnection) {
    ServerOptions options;
    options.message_bytes = message_bytes;
    RunningStudio running(small_scene_text, nullptr, options);
    constexpr int rounds = 10'000;
    Random random(20);
    std::size_t memory = 0;
    int answered = 0;
    auto page = std::make_unique<WatchingPage>(running);
    ASSERT_TRUE(page->comes_to("idle"));
    for (int round = 0; round < rounds; ++round) {
        if (round == rounds / 5)
            memory = resident_bytes();
        if (random.below(2) == 0) {
            const std::string text = malformed_text(random);
            page->page.send_text(text);
            if (std::holds_alternative<Command>(parse_command(text)))
                continue;
            ASSERT_FALSE(page->next("error").is_null()) << "in round " << round;
            ++answered;
        } else {
            page->page.connection.send(malformed_frames(random));
            page->page.connection.finish_sending();
            ASSERT_TRUE(page->page.connection.is_closed()) << "in round " << round;
            page = std::make_unique<WatchingPage>(running);
            ASSERT_TRUE(page->is_open()) << "in round " << round;
        }
    }
    EXPECT_GT(answered, rounds / 3);
    expect_no_growth(memory);
    page.reset();
    EXPECT_TRUE(eventually([&] { return running.server.counters().connections == 0; }));
    EXPECT_EQ(running.server.counters().queued_bytes, 0U);
    EXPECT_TRUE(running.is_well());
}

std::string mutated(std::string text, Random& random) {
    for (int i = random.below(4); i >= 0; --i) {
        const auto place = static_cast<std::size_t>(random.below(static_cast<int>(text.size())));
        switch (random.below(4)) {
        case 0:
            text[place] = static_cast<char>(random.below(256));
            break;
        case 1:
            text.erase(place, 1 + static_cast<std::size_t>(random.below(20)));
            break;
        case 2:
            text.insert(place, random_bytes(random, 20));
            break;
        default:
            text.insert(place, text.substr(place, 40));
        }
        if (text.empty())
            text.push_back('x');
    }
    return text;
}

TEST(ServerFuzz, MalformedRequestsAreSurvived) {
    RunningServer running;
    const std::uint16_t port = running.port();
    Random random(21);
    int answered = 0;
    for (int round = 0; round < 2000; ++round) {
        const std::string whole = random.below(2)
                                      ? request("GET", "/api/echo?a=b%20c", port, running.token)
                                      : request("POST", "/api/mesh?name=a.obj", port, running.token, "", "v 0 0 0\n");
        RawConnection connection(port);
        connection.send(mutated(whole, random));
        connection.finish_sending();
        answered += connection.response().status != 0 ? 1 : 0;
    }
    EXPECT_GT(answered, 1000);
    EXPECT_TRUE(running.is_well());
    EXPECT_TRUE(eventually([&] { return running.server.counters().connections == 0; }));
}

/// A tetrahedron in each format that can be sent.
std::map<std::string, std::string> good_meshes() {
    std::string stl(80, ' ');
    const auto add = [&](const auto& value) { stl.append(reinterpret_cast<const char*>(&value), sizeof value); };
    constexpr std::array<std::array<float, 3>, 4> places{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    constexpr std::array<std::array<std::size_t, 3>, 4> faces{{{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
    add(std::uint32_t{4});
    for (const auto& face : faces) {
        add(std::array<float, 3>{});
        for (const std::size_t corner : face)
            add(places[corner]);
        add(std::uint16_t{0});
    }
    const std::string points = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n", corners = "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
    return {{"a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvt 0 0\nf 1/1 3/1 2/1\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"},
            {"a.off", "OFF\n4 4 0\n" + points + corners},
            {"a.ply", "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty double y\nproperty double "
                      "z\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n" +
                          points + corners},
            {"a.stl", stl}};
}

TEST(StudioFuzz, MalformedUploadsAreRefusedOrOpened) {
    RunningStudio running(nullptr);
    Random random(22);
    int opened = 0, refused = 0;
    for (const auto& [name, bytes] : good_meshes())
        ASSERT_EQ(running.post("/api/mesh?name=" + name, bytes).status, 200) << name;
    for (int round = 0; round < 100; ++round)
        for (const auto& [name, bytes] : good_meshes()) {
            const RawResponse answer = running.post("/api/mesh?name=" + name, mutated(bytes, random));
            ASSERT_TRUE(answer.status == 200 || answer.status == 422) << answer.status << " in round " << round;
            ++(answer.status == 200 ? opened : refused);
        }
    EXPECT_GT(refused, 100);
    EXPECT_GT(opened, 10);
    EXPECT_TRUE(running.is_well());
}

} // namespace
} // namespace plisse::studio
