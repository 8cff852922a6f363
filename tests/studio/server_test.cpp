#include <studio/server.h>

#include <csignal>
#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <studio/http_text.h>

#include "raw_client.h"
#include "running_server.h"

namespace plisse::studio {
namespace {

using std::chrono::milliseconds;

/// A GET of the page as a browser sends it at first: no cookie, no Origin.
std::string first_request(std::string_view target, const std::string& host) {
    return "GET " + std::string(target) + " HTTP/1.1\r\nHost: " + host + "\r\n\r\n";
}

TEST(Server, TokensAreLongAndNew) {
    const std::string token = random_token();
    EXPECT_EQ(token.size(), 32U);
    EXPECT_EQ(token.find_first_not_of("0123456789abcdef"), std::string::npos);
    EXPECT_NE(token, random_token());
}

TEST(Server, TheAddressOpensThePageAndTheCookieTheRest) {
    RunningServer running;
    const std::string host = "127.0.0.1:" + std::to_string(running.port());
    EXPECT_EQ(running.server.url(), "http://" + host + "/?token=" + running.token);
    const RawResponse page = ask(running.port(), first_request("/?token=" + running.token, host));
    EXPECT_EQ(page.status, 200);
    EXPECT_EQ(page.body, "<!doctype html>");
    EXPECT_EQ(page.fields.at("content-type"), "text/html");
    EXPECT_EQ(page.fields.at("set-cookie"),
              cookie_name(running.port()) + "=" + running.token + "; Path=/; HttpOnly; SameSite=Strict");
    EXPECT_EQ(page.fields.at("cache-control"), "no-store");
    EXPECT_EQ(page.fields.at("referrer-policy"), "no-referrer");
    EXPECT_EQ(page.fields.at("x-content-type-options"), "nosniff");
    EXPECT_NE(page.fields.at("content-security-policy").find("frame-ancestors 'none'"), std::string::npos);

    const RawResponse script = ask(running.port(), request("GET", "/assets/a.js", running.port(), running.token));
    EXPECT_EQ(script.status, 200);
    EXPECT_EQ(script.body, "let a = 1;");
    EXPECT_FALSE(script.fields.contains("set-cookie"));
    EXPECT_EQ(ask(running.port(), request("GET", "/", running.port(), running.token)).body, "<!doctype html>");
}

TEST(Server, WithoutTheTokenNothingIsGiven) {
    RunningServer running;
    const std::uint16_t port = running.port();
    const std::string host = "127.0.0.1:" + std::to_string(port);
    for (const char* target : {"/", "/?token=", "/?token=0123456789abcdef0123456789abcdef", "/assets/a.js", "/api/echo",
                               "/api/session", "/nothing"})
        EXPECT_EQ(ask(port, first_request(target, host)).status, 403) << target;
    EXPECT_EQ(ask(port, first_request("/assets/a.js?token=" + running.token, host)).status, 403)
        << "only the page takes it from the address";
    EXPECT_EQ(ask(port, request("GET", "/?token=wrong", port, running.token)).status, 403);
    for (const std::string& token :
         {std::string(), running.token.substr(1), running.token + "0", std::string(32, '0')}) {
        EXPECT_EQ(ask(port, request("GET", "/assets/a.js", port, token)).status, 403);
        EXPECT_EQ(ask(port, request("POST", "/api/mesh", port, token)).status, 403);
        EXPECT_FALSE(RawPage(port, token).is_open());
    }
    std::string other_port = request("GET", "/assets/a.js", port, running.token);
    other_port.replace(other_port.find(cookie_name(port)), cookie_name(port).size(), cookie_name(1));
    EXPECT_EQ(ask(port, other_port).status, 403) << "another studio of this machine has its own cookie";
    EXPECT_GE(running.server.counters().refused, 20U);
    EXPECT_EQ(running.application.joins, 0U);
}

TEST(Server, OtherHostsAreRefused) {
    RunningServer running;
    const std::string port = std::to_string(running.port());
    const auto status = [&](const std::string& host_lines) {
        return ask(running.port(), "GET /?token=" + running.token + " HTTP/1.1\r\n" + host_lines + "\r\n").status;
    };
    EXPECT_EQ(status("Host: 127.0.0.1:" + port + "\r\n"), 200);
    EXPECT_EQ(status("Host: localhost:" + port + "\r\n"), 200);
    EXPECT_EQ(status(""), 403);
    EXPECT_EQ(status("Host: \r\n"), 403);
    EXPECT_EQ(status("Host: 127.0.0.1\r\n"), 403);
    EXPECT_EQ(status("Host: 127.0.0.1:1\r\n"), 403);
    EXPECT_EQ(status("Host: localhost.evil.example:" + port + "\r\n"), 403);
    EXPECT_EQ(status("Host: evil.example:" + port + "\r\n"), 403);
    EXPECT_EQ(status("Host: 127.0.0.1:" + port + "\r\nHost: evil.example\r\n"), 403);
}

TEST(Server, OtherOriginsAreRefused) {
    RunningServer running;
    const std::uint16_t port = running.port();
    const std::string host = "127.0.0.1:" + std::to_string(port);
    const auto status = [&](const std::string& method, const std::string& target, const std::string& lines) {
        return ask(port, method + " " + target + " HTTP/1.1\r\nHost: " + host + "\r\nCookie: " + cookie_name(port) +
                             "=" + running.token + "\r\n" + lines + "\r\n")
            .status;
    };
    const std::string upgrade = "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
                                "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n";
    const std::string own = "Origin: http://" + host + "\r\n";
    EXPECT_EQ(status("GET", "/api/echo", ""), 200);
    EXPECT_EQ(status("GET", "/api/echo", own), 200);
    EXPECT_EQ(status("POST", "/api/mesh", own + "Content-Length: 0\r\n"), 200);
    EXPECT_EQ(status("GET", "/api/session", own + upgrade), 101);
    for (const std::string& origin : {std::string("http://evil.example"), std::string("null"), "https://" + host,
                                      "http://localhost:" + std::to_string(port), std::string("http://127.0.0.1")}) {
        const std::string line = "Origin: " + origin + "\r\n";
        EXPECT_EQ(status("GET", "/api/echo", line), 403) << origin;
        EXPECT_EQ(status("POST", "/api/mesh", line + "Content-Length: 0\r\n"), 403) << origin;
        EXPECT_EQ(status("GET", "/api/session", line + upgrade), 403) << origin;
    }
    EXPECT_EQ(status("POST", "/api/mesh", "Content-Length: 0\r\n"), 403) << "a POST must say whence it comes";
    EXPECT_EQ(status("GET", "/api/session", upgrade), 403) << "and so must a WebSocket";
    EXPECT_EQ(status("GET", "/api/echo", own + own), 403);
}

TEST(Server, NoPathLeadsOutside) {
    RunningServer running;
    for (const char* target :
         {"/../etc/passwd", "/assets/../../etc/passwd", "/%2e%2e/%2e%2e/etc/passwd", "//etc/passwd", "/assets/%2e%2e/a",
          "/assets\\a.js", "/assets/a.js%00", "/api/../assets/a.js", "/api/files/..%2f..%2fetc%2fpasswd", "/%"})
        EXPECT_EQ(ask(running.port(), request("GET", target, running.port(), running.token)).status, 400) << target;
    for (const char* target : {"/etc/passwd", "/assets", "/assets/", "/assets/a.js/", "/ASSETS/a.js", "/assets/b.js"})
        EXPECT_EQ(ask(running.port(), request("GET", target, running.port(), running.token)).status, 404) << target;
}

TEST(Server, RequestsReachTheApplicationDecoded) {
    RunningServer running;
    const std::uint16_t port = running.port();
    EXPECT_EQ(ask(port, request("GET", "/api/a%20b?name=c%2Fd&x=1", port, running.token)).body,
              "GET /api/a b\nname=c/d\nx=1\n0");
    EXPECT_EQ(ask(port, request("POST", "/api/mesh?name=a.obj", port, running.token, "", "v 0 0 0")).body,
              "POST /api/mesh\nname=a.obj\n7");
}

TEST(Server, UploadsAreBounded) {
    ServerOptions options;
    options.uploads = {{"/api/mesh", 100'000}, {"/api/scene", 10}};
    RunningServer running(options);
    const std::uint16_t port = running.port();
    const auto status = [&](const std::string& target, std::size_t bytes) {
        return ask(port, request("POST", target, port, running.token, "", std::string(bytes, 'x'))).status;
    };
    EXPECT_EQ(status("/api/mesh", 100'000), 200);
    EXPECT_EQ(status("/api/scene", 10), 200);
    EXPECT_EQ(status("/api/scene", 11), 413);
    EXPECT_EQ(status("/api/mesh", 100'001), 413);
    EXPECT_EQ(status("/api/mesh", 30'000'000), 413) << "the answer arrives although the body was not read";
    EXPECT_EQ(status("/api/echo", 1), 405);
    EXPECT_EQ(status("/assets/a.js", 1), 405);
    const std::string start = "POST /api/mesh HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(port) +
                              "\r\nOrigin: http://127.0.0.1:" + std::to_string(port) +
                              "\r\nCookie: " + cookie_name(port) + "=" + running.token + "\r\n";
    EXPECT_EQ(ask(port, start + "Transfer-Encoding: chunked\r\n\r\n3\r\nabc\r\n0\r\n\r\n").status, 411);
    EXPECT_EQ(ask(port, start + "Content-Length: 18446744073709551615\r\n\r\n").status, 413);
    EXPECT_EQ(ask(port, start + "Content-Length: 99999999999999999999999\r\n\r\n").status, 400);
    EXPECT_EQ(ask(port, start + "Content-Length: -1\r\n\r\n").status, 400);
    EXPECT_EQ(ask(port, request("GET", "/api/echo", port, running.token, "Content-Length: 3\r\n", "abc")).status, 400);
    EXPECT_TRUE(running.is_well());
}

TEST(Server, OnlyTwoUploadsAreHeldAtATime) {
    RunningServer running;
    const std::uint16_t port = running.port();
    const std::string half = request("POST", "/api/mesh", port, running.token, "", "abc");
    {
        RawConnection first(port), second(port);
        first.send(half.substr(0, half.size() - 1));
        second.send(half.substr(0, half.size() - 1));
        EXPECT_TRUE(eventually([&] { return ask(port, half).status == 503; }));
        first.send("c");
        EXPECT_EQ(first.response().status, 200);
        EXPECT_EQ(ask(port, half).status, 200) << "its place is free again";
    }
    EXPECT_TRUE(eventually([&] { return running.server.counters().connections == 0; }));
    RawConnection first(port), second(port);
    for (RawConnection* connection : {&first, &second}) {
        connection->send(half);
        EXPECT_EQ(connection->response().status, 200) << "so is the place of one cut off";
    }
}

TEST(Server, ConnectionsAreKept) {
    RunningServer running;
    RawConnection connection(running.port());
    const std::string ask_for_script = request("GET", "/assets/a.js", running.port(), running.token);
    connection.send(ask_for_script + ask_for_script);
    EXPECT_EQ(connection.response().body, "let a = 1;");
    EXPECT_EQ(connection.response().body, "let a = 1;") << "sent before the first was answered";
    connection.send(request("GET", "/nothing", running.port(), running.token));
    EXPECT_EQ(connection.response().status, 404);
    connection.send(request("POST", "/api/scene", running.port(), running.token, "", "{}"));
    EXPECT_EQ(connection.response().status, 200);
    connection.send(request("GET", "/assets/a.js", running.port(), running.token, "Connection: close\r\n"));
    EXPECT_EQ(connection.response().status, 200);
    EXPECT_TRUE(connection.is_closed());
}

TEST(Server, WhatIsNotUnderstoodIsRefused) {
    RunningServer running;
    const std::uint16_t port = running.port();
    for (const char* method : {"PUT", "DELETE", "HEAD", "OPTIONS", "TRACE", "DANCE"})
        EXPECT_EQ(ask(port, request(method, "/assets/a.js", port, running.token)).status, 405) << method;
    EXPECT_EQ(ask(port, "hello\r\n\r\n").status, 400);
    EXPECT_EQ(ask(port, request("GET", "/", port, running.token, "X: " + std::string(20'000, 'x') + "\r\n")).status,
              431);
    EXPECT_EQ(ask(port, request("GET", "/api/session", port, running.token)).status, 426);
    const auto body = nlohmann::json::parse(ask(port, request("GET", "/nothing", port, running.token)).body);
    EXPECT_EQ(body["ok"], false);
    EXPECT_TRUE(body["message"].is_string());
}

TEST(Server, FilesAreStreamedAsDownloads) {
    const auto folder = std::filesystem::temp_directory_path() / ("plisse_studio_" + random_token());
    std::filesystem::create_directory(folder);
    const std::string content(3'000'000, 'y');
    std::ofstream(folder / "file") << content;
    std::filesystem::create_symlink(folder / "file", folder / "link");
    RunningServer running;
    const auto response = [&](const char* name) {
        running.application.file = folder / name;
        return ask(running.port(), request("GET", "/api/file", running.port(), running.token));
    };
    const RawResponse download = response("file");
    EXPECT_EQ(download.status, 200);
    EXPECT_EQ(download.body, content);
    EXPECT_EQ(download.fields.at("content-disposition"), "attachment; filename=\"cloth___.obj\"");
    EXPECT_EQ(response("none").status, 404);
    EXPECT_EQ(response("link").status, 404);
    EXPECT_EQ(response(".").status, 404);
    std::filesystem::remove_all(folder);
}

TEST(Server, AnswersMayComeLate) {
    RunningServer running;
    const std::uint16_t port = running.port();
    RawConnection connection(port);
    connection.send(request("GET", "/api/late", port, running.token));
    ASSERT_TRUE(running.application.wait([&] { return !running.application.late.empty(); }));
    EXPECT_TRUE(running.is_well());
    HttpAnswer answer;
    answer.status = 422;
    answer.body = "late";
    running.application.late[0](answer);
    running.application.late[0](HttpAnswer{});
    const RawResponse response = connection.response();
    EXPECT_EQ(response.status, 422);
    EXPECT_EQ(response.body, "late");
    connection.send(request("GET", "/api/echo", port, running.token));
    EXPECT_EQ(connection.response().status, 200) << "the second answer to the first request is not sent";

    EXPECT_EQ(ask(port, request("GET", "/api/never", port, running.token)).status, 500);
    EXPECT_EQ(ask(port, request("GET", "/api/throw", port, running.token)).status, 500);
}

TEST(Server, AnswersMayComeTooLate) {
    std::vector<Reply> late;
    {
        RunningServer running;
        RawConnection(running.port()).send(request("GET", "/api/late", running.port(), running.token));
        RawConnection connection(running.port());
        connection.send(request("GET", "/api/late", running.port(), running.token));
        ASSERT_TRUE(running.application.wait([&] { return running.application.late.size() == 2; }));
        running.application.late[0](HttpAnswer{}); // its connection is closed
        EXPECT_TRUE(running.is_well());
        late.swap(running.application.late);
    }
    for (const Reply& reply : late)
        reply(HttpAnswer{}); // the server is gone
}

TEST(Server, SlowRequestsEnd) {
    ServerOptions options;
    options.header_timeout = options.stall_timeout = options.idle_timeout = milliseconds(100);
    RunningServer running(options);
    const std::uint16_t port = running.port();
    RawConnection silent(port), header(port), body(port), idle(port);
    const std::string upload = request("POST", "/api/mesh", port, running.token, "", "abc");
    header.send(upload.substr(0, 30));
    body.send(upload.substr(0, upload.size() - 1));
    idle.send(request("GET", "/api/echo", port, running.token));
    EXPECT_EQ(idle.response().status, 200);
    EXPECT_TRUE(silent.is_closed());
    EXPECT_TRUE(header.is_closed());
    EXPECT_TRUE(body.is_closed());
    EXPECT_TRUE(idle.is_closed());
}

TEST(Server, ConnectionsAreBounded) {
    ServerOptions options;
    options.connections = 3;
    RunningServer running(options);
    {
        RawConnection one(running.port()), two(running.port()), three(running.port());
        ASSERT_TRUE(eventually([&] { return running.server.counters().connections == 3; }));
        RawConnection four(running.port());
        EXPECT_TRUE(four.is_closed());
    }
    EXPECT_TRUE(eventually([&] { return running.is_well(); }));
}

TEST(Server, PortsThatAreTakenAreNamed) {
    RunningServer running;
    ServerOptions options;
    options.port = running.port();
    FakeApplication application;
    try {
        const Server second(options, application);
        FAIL() << "two servers at one port";
    } catch (const std::runtime_error& error) {
        EXPECT_NE(std::string(error.what()).find(std::to_string(options.port)), std::string::npos) << error.what();
    }
}

TEST(Server, StopsBeforeItRuns) {
    FakeApplication application;
    Server server({}, application);
    server.stop();
    server.run();
    EXPECT_EQ(server.counters().connections, 0U);
}

TEST(Server, StopsAtOnceWhenThePagesAnswer) {
    RunningServer running;
    RawPage page(running.port(), running.token);
    ASSERT_NE(running.only_client(), 0U);
    const auto start = std::chrono::steady_clock::now();
    running.server.stop();
    const auto frame = page.frame();
    ASSERT_TRUE(frame);
    page.connection.send(client_frame(close_frame, frame->payload));
    page.connection.finish_sending();
    running.stop();
    EXPECT_LT(std::chrono::steady_clock::now() - start, milliseconds(900));
    EXPECT_EQ(running.application.leaves, 1U);
}

Server* interrupted = nullptr;

TEST(Server, StopsFromASignalHandler) {
    RunningServer running;
    ASSERT_TRUE(running.is_well());
    RawPage page(running.port(), running.token);
    ASSERT_NE(running.only_client(), 0U);
    RawConnection half(running.port());
    half.send("GET / HT");
    interrupted = &running.server;
    const auto previous = std::signal(SIGUSR1, [](int) { interrupted->stop(); });
    std::raise(SIGUSR1);
    std::signal(SIGUSR1, previous);
    const auto frame = page.frame();
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->opcode, close_frame);
    EXPECT_EQ(frame->payload.substr(0, 2), "\x03\xE9") << "1001: going away";
    EXPECT_TRUE(half.is_closed());
    const auto start = std::chrono::steady_clock::now();
    running.stop();
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(3)) << "the page has not said good-bye";
    EXPECT_EQ(running.application.leaves, running.application.joins);
}

} // namespace
} // namespace plisse::studio
