#include <studio/server.h>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "raw_client.h"
#include "running_server.h"

namespace plisse::studio {
namespace {

using std::chrono::milliseconds;

std::shared_ptr<const Bytes> bytes(const std::string& text) {
    return std::make_shared<const Bytes>(text.begin(), text.end());
}

std::shared_ptr<const Bytes> bytes(std::size_t count, unsigned char value) {
    return std::make_shared<const Bytes>(count, value);
}

TEST(Pages, TextsGoBothWays) {
    RunningServer running;
    running.application.server = &running.server;
    RawPage page(running.port(), running.token);
    ASSERT_TRUE(page.is_open());
    page.send_text("caf\xC3\xA9");
    const auto frame = page.frame();
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->opcode, text_frame);
    EXPECT_EQ(frame->payload, "caf\xC3\xA9");
    EXPECT_EQ(running.server.counters().messages, 1U);
}

TEST(Pages, SeveralWatchOneSession) {
    RunningServer running;
    RawPage one(running.port(), running.token), two(running.port(), running.token);
    ASSERT_TRUE(running.application.wait([&] { return running.application.clients.size() == 2; }));
    running.server.send_text_to_all("both");
    EXPECT_EQ(one.frame()->payload, "both");
    EXPECT_EQ(two.frame()->payload, "both");
    running.server.send_text(*running.application.clients.begin(), "first");
    EXPECT_EQ(one.frame()->payload, "first");
    running.server.send_text(12345, "nobody");
    running.server.send_mesh(12345, bytes("nobody"));
    running.server.offer_positions(12345, bytes("nobody"));
}

TEST(Pages, MeshesGoOutBeforeTheirPositions) {
    RunningServer running;
    RawPage page(running.port(), running.token);
    const ClientId client = running.only_client();
    for (int version = 0; version < 300; ++version) {
        running.server.send_mesh(client, bytes(fmt::format("m{}", version)));
        for (int step = 0; step < 3; ++step)
            running.server.offer_positions(client, bytes(fmt::format("p{}", version)));
    }
    std::string version;
    int meshes = 0, positions = 0;
    while (meshes < 300 || version.empty() || positions == 0) {
        const auto frame = page.frame();
        ASSERT_TRUE(frame);
        ASSERT_EQ(frame->opcode, binary_frame);
        if (frame->payload[0] == 'm') {
            version = frame->payload.substr(1);
            EXPECT_EQ(version, std::to_string(meshes++));
        } else {
            EXPECT_EQ(frame->payload.substr(1), version);
            ++positions;
        }
    }
}

TEST(Pages, NewestPositionsReplaceOlderOnesForASlowPage) {
    RunningServer running;
    constexpr std::size_t size = 1'000'000;
    RawPage slow(running.port(), running.token, 16 << 10);
    const ClientId client = running.only_client();
    constexpr int offers = 2000; // 2 GB in all
    for (int i = 0; i < offers; ++i) {
        running.server.offer_positions(client,
                                       bytes(size, static_cast<unsigned char>(i == offers - 1 ? 255 : i % 200)));
        if (i % 100 == 0) {
            std::this_thread::sleep_for(milliseconds(1));
            EXPECT_LE(running.server.counters().waiting_positions, 1U);
            EXPECT_EQ(running.server.counters().queued_bytes, 0U);
        }
    }
    const ServerCounters counters = running.server.counters();
    EXPECT_EQ(counters.waiting_positions, 1U);
    EXPECT_LE(counters.sent_positions, 3U) << "what the kernel took";
    EXPECT_EQ(counters.sent_positions + counters.replaced_positions + 1, static_cast<std::uint64_t>(offers));
    int frames = 0;
    for (;;) {
        const auto frame = slow.frame();
        ASSERT_TRUE(frame);
        ASSERT_EQ(frame->payload.size(), size);
        ++frames;
        if (static_cast<unsigned char>(frame->payload[0]) == 255)
            break;
    }
    EXPECT_LE(frames, 4);
    EXPECT_EQ(running.server.counters().clients, 1U) << "a slow page stays";
}

TEST(Pages, AFullQueueDisconnectsItsPageOnly) {
    ServerOptions options;
    options.text_queue_messages = 100;
    RunningServer running(options);
    RawPage slow(running.port(), running.token, 16 << 10);
    const ClientId slow_client = running.only_client();
    RawPage quick(running.port(), running.token);
    ASSERT_TRUE(running.application.wait([&] { return running.application.clients.size() == 2; }));
    const std::string text(50'000, 'x');
    int sent = 0;
    while (running.server.counters().overflows == 0 && sent < 1000) {
        running.server.send_text_to_all(text);
        ++sent;
        ASSERT_EQ(quick.frame()->payload, text);
        EXPECT_LE(running.server.counters().queued_bytes, 100 * text.size());
    }
    EXPECT_GE(sent, 100);
    EXPECT_TRUE(running.application.wait([&] { return running.application.clients.size() == 1; }));
    EXPECT_FALSE(running.application.clients.contains(slow_client));
    EXPECT_TRUE(slow.connection.is_closed());
    running.server.send_text_to_all("still here");
    EXPECT_EQ(quick.frame()->payload, "still here");
    EXPECT_EQ(running.server.counters().overflows, 1U);
    EXPECT_EQ(running.server.counters().queued_bytes, 0U);
    EXPECT_TRUE(RawPage(running.port(), running.token).is_open()) << "it may come back";
}

TEST(Pages, MeshesAreBoundedByTheirBytes) {
    ServerOptions options;
    options.mesh_queue_bytes = 5'000'000;
    RunningServer running(options);
    RawPage slow(running.port(), running.token, 16 << 10);
    const ClientId client = running.only_client();
    for (int i = 0; i < 20 && running.server.counters().overflows == 0; ++i)
        running.server.send_mesh(client, bytes(1'000'000, 1));
    EXPECT_EQ(running.server.counters().overflows, 1U);
    EXPECT_TRUE(running.application.wait([&] { return running.application.clients.empty(); }));
}

TEST(Pages, DeadOnesAreNoticed) {
    ServerOptions options;
    options.idle_timeout = milliseconds(200);
    RunningServer running(options);
    RawPage dead(running.port(), running.token); // never reads, so never answers a ping
    RawPage alive(running.port(), running.token);
    ASSERT_TRUE(running.application.wait([&] { return running.application.clients.size() == 2; }));
    std::thread watcher([&] { alive.frame(); }); // answers pings until the good-bye
    EXPECT_TRUE(running.application.wait([&] { return running.application.clients.size() == 1; }));
    std::this_thread::sleep_for(milliseconds(600));
    EXPECT_EQ(running.server.counters().clients, 1U);
    running.stop();
    watcher.join();
}

/// The code of the close frame that answers these bytes; 0 when there is none.
int close_code(RunningServer& running, const std::string& sent) {
    RawPage page(running.port(), running.token);
    page.connection.send(sent);
    for (;;) {
        const auto frame = page.frame();
        if (!frame)
            return 0;
        if (frame->opcode == close_frame)
            return static_cast<unsigned char>(frame->payload[0]) * 256 + static_cast<unsigned char>(frame->payload[1]);
    }
}

TEST(Pages, MalformedFramesCloseTheirConnection) {
    ServerOptions options;
    options.message_bytes = 1000;
    RunningServer running(options);
    running.application.server = &running.server;
    const std::string long_text(1001, 'x');
    EXPECT_EQ(close_code(running, client_frame(binary_frame, "ab")), 1003);
    EXPECT_EQ(close_code(running, client_frame(text_frame, "\xFF")), 1007);
    EXPECT_EQ(close_code(running, client_frame(text_frame, "\xC3", false) + client_frame(0, "(")), 1007);
    EXPECT_EQ(close_code(running, client_frame(text_frame, long_text)), 1009);
    std::string fragments = client_frame(text_frame, "", false);
    for (int i = 0; i < 11; ++i)
        fragments += client_frame(0, long_text.substr(0, 100), i == 10);
    EXPECT_EQ(close_code(running, fragments), 1009);
    EXPECT_EQ(close_code(running, client_frame(3, "")), 1002);
    EXPECT_EQ(close_code(running, client_frame(0, "no beginning")), 1002);
    EXPECT_EQ(close_code(running, std::string("\x81\x01x", 3)), 1002) << "not masked";
    EXPECT_EQ(close_code(running, client_frame(ping_frame, long_text)), 1002);
    EXPECT_EQ(close_code(running, std::string("\x81\xFF\x7F\xFF\xFF\xFF\xFF\xFF\xFF\xFF", 10) + "mask"), 1009);
    EXPECT_EQ(close_code(running, client_frame(text_frame, "throw")), 1011);
    EXPECT_EQ(close_code(running, client_frame(close_frame, "\x03\xE8")), 1000);
    EXPECT_TRUE(running.application.texts.empty());
    EXPECT_TRUE(running.is_well());
}

TEST(Pages, FragmentsArriveWhole) {
    RunningServer running;
    running.application.server = &running.server;
    RawPage page(running.port(), running.token);
    page.connection.send(client_frame(text_frame, "one \xC3", false) + client_frame(ping_frame, "") +
                         client_frame(0, "\xA9", false) + client_frame(0, " two"));
    std::optional<RawFrame> frame;
    do
        frame = page.frame();
    while (frame && frame->opcode == 10);
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->payload, "one \xC3\xA9 two");
}

TEST(Pages, ManyComeAndGo) {
    RunningServer running;
    running.application.server = &running.server;
    for (int round = 0; round < 300; ++round) {
        RawPage page(running.port(), running.token);
        ASSERT_TRUE(page.is_open());
        running.server.send_text_to_all("hello");
        if (round % 3 == 0)
            page.send_text("hello");
        if (round % 3 == 1)
            page.connection.send(client_frame(close_frame, ""));
    }
    EXPECT_TRUE(running.application.wait([&] { return running.application.leaves == 300; }));
    EXPECT_EQ(running.application.joins, 300U);
    EXPECT_TRUE(eventually([&] { return running.server.counters().connections == 0; }));
    EXPECT_EQ(running.server.counters().queued_bytes, 0U);
}

TEST(Pages, SendingFromManyThreadsIsSafe) {
    RunningServer running;
    std::vector<std::thread> threads;
    std::atomic<bool> done{false};
    for (int thread = 0; thread < 3; ++thread)
        threads.emplace_back([&, thread] {
            for (ClientId client = 1; !done; client = client % 40 + 1) {
                running.server.send_text(client, "t");
                running.server.send_mesh(client, bytes(1000, 1));
                running.server.offer_positions(client, bytes(1000, 2));
                if (thread == 0)
                    running.server.send_text_to_all("a");
            }
        });
    for (int page = 0; page < 40; ++page)
        EXPECT_TRUE(RawPage(running.port(), running.token).is_open());
    done = true;
    for (std::thread& thread : threads)
        thread.join();
    EXPECT_TRUE(eventually([&] { return running.server.counters().clients == 0; }));
    EXPECT_TRUE(running.is_well());
}

} // namespace
} // namespace plisse::studio
