// SPDX-License-Identifier: BSD-3-Clause
// Responses of the server to valid and invalid requests.
#include <repel/base/setup_error.hpp>

#include "end_to_end/folder.hpp"
#include "visual/fake_page_handler.hpp"

namespace repel::visual {
namespace server_http_test {

using test::Answer;
using test::Ask;
using test::ask;
using test::Line;

TEST(ServerHttp, FilesComeWithTheirTypeAndMayLoadNothingFromElsewhere) {
  const Stage stage;
  const Answer page = ask(stage.port, {});
  EXPECT_EQ(page.status, 200);
  EXPECT_EQ(page.body, "<p>page</p>");
  EXPECT_TRUE(page.has("Content-Type: text/html; charset=utf-8")) << page.head;
  EXPECT_TRUE(page.has("X-Content-Type-Options: nosniff")) << page.head;
  EXPECT_NE(page.head.find("Content-Security-Policy: default-src 'self';"), std::string::npos);
  EXPECT_NE(page.head.find("frame-ancestors 'none'"), std::string::npos);
  for (const char* foreign : {"http:", "https:", " *", "unsafe-inline", "unsafe-eval"}) {
    EXPECT_EQ(page.head.find(foreign), std::string::npos) << foreign;
  }
  const Answer style = ask(stage.port, {"GET", "/page.css?v=1"});
  EXPECT_EQ(style.status, 200);
  EXPECT_TRUE(style.has("Content-Type: text/css; charset=utf-8")) << style.head;
  EXPECT_EQ(style.body, "p {}");
}

TEST(ServerHttp, FilesAreCompressedForThoseWhoAcceptIt) {
  const Stage stage;
  const Answer plain = ask(stage.port, {"GET", "/page.css"});
  EXPECT_FALSE(plain.has("Content-Encoding: gzip")) << plain.head;
  EXPECT_TRUE(plain.has("Vary: Accept-Encoding")) << plain.head;
  const Answer packed = ask(stage.port, {"GET", "/page.css", "", "Accept-Encoding: br, gzip\r\n"});
  EXPECT_EQ(packed.status, 200);
  EXPECT_TRUE(packed.has("Content-Encoding: gzip")) << packed.head;
  EXPECT_TRUE(packed.has("Content-Type: text/css; charset=utf-8")) << packed.head;
  EXPECT_TRUE(packed.has("Vary: Accept-Encoding")) << packed.head;
  EXPECT_EQ(packed.body.substr(0, 2), "\x1f\x8b");
}

TEST(ServerHttp, WhoHasAFileIsToldThatItIsTheSame) {
  const Stage stage;
  const auto tag_of = [](const Answer& answer) {
    const std::size_t from = answer.head.find("ETag: ") + 6;
    return answer.head.substr(from, answer.head.find("\r\n", from) - from);
  };
  const std::string gzip = "Accept-Encoding: gzip\r\n";
  const std::string plain = tag_of(ask(stage.port, {"GET", "/page.css"}));
  const std::string packed = tag_of(ask(stage.port, {"GET", "/page.css", "", gzip}));
  EXPECT_EQ(plain.size(), 18U) << plain;
  EXPECT_NE(plain, packed);
  EXPECT_NE(plain, tag_of(ask(stage.port, {"GET", "/"})));
  const auto known = [&](const std::string& tag, const std::string& more) {
    return ask(stage.port, {"GET", "/page.css", "", "If-None-Match: " + tag + "\r\n" + more});
  };
  const Answer same = known("W/\"0\", " + packed, gzip);
  EXPECT_EQ(same.status, 304);
  EXPECT_EQ(same.body, "");
  EXPECT_EQ(tag_of(same), packed);
  EXPECT_TRUE(same.has("Cache-Control: no-cache")) << same.head;
  EXPECT_EQ(known(plain, "").status, 304);
  EXPECT_EQ(known(packed, "").status, 200);
  EXPECT_EQ(known("\"0123456789abcdef\"", "").status, 200);
}

TEST(ServerHttp, WhatIsNotThereIsNotFound) {
  const Stage stage;
  for (const char* target : {"/no.css", "/../page.css", "/%70age.css", "//", "/page.css/", "*",
                             "http://127.0.0.1/", "/live", "/?/../../etc/passwd"}) {
    const int status = ask(stage.port, {"GET", target}).status;
    EXPECT_EQ(status, std::string(target) == "/?/../../etc/passwd" ? 200 : 404) << target;
  }
}

TEST(ServerHttp, OtherMethodsAreRefused) {
  const Stage stage;
  const Answer head = ask(stage.port, {"HEAD", "/page.css"});
  EXPECT_EQ(head.status, 200);
  EXPECT_EQ(head.body, "");
  for (const char* method : {"POST", "PUT", "DELETE", "OPTIONS", "TRACE", "CONNECT"}) {
    EXPECT_EQ(ask(stage.port, {method}).status, 405) << method;
  }
  const std::string upgrade = test::upgrade_lines();
  EXPECT_EQ(ask(stage.port, {"POST", "/live", "", upgrade}).status / 100, 4);
}

// A page of another site, whatever its name resolves to.
TEST(ServerHttp, OtherHostsAndOriginsAreForbidden) {
  const Stage stage;
  const std::string port = ":" + std::to_string(stage.port);
  for (const char* target : {"/", "/live"}) {
    const std::string upgrade = target[1] == '\0' ? "" : test::upgrade_lines();
    for (const std::string& host : {"evil.example" + port, std::string("127.0.0.1:1"),
                                    std::string("127.0.0.1"), std::string(" ")}) {
      EXPECT_EQ(ask(stage.port, {"GET", target, host, upgrade}).status, 403) << target << host;
    }
    for (const std::string& origin :
         {std::string("null"), "http://evil.example" + port, std::string("http://localhost:1"),
          "https://127.0.0.1" + port, std::string("file://"), "http://localhost" + port,
          "http://127.0.0.2" + port, "http://8.8.8.8" + port, "http://[::1]" + port}) {
      std::string lines = upgrade;
      lines += "Origin: " + origin + "\r\n";
      EXPECT_EQ(ask(stage.port, {"GET", target, "", lines}).status, 403) << target << origin;
    }
  }
  EXPECT_EQ(stage.show.count("opened"), 0);
  EXPECT_EQ(ask(stage.port, {"GET", "/", "localhost" + port}).status, 200);
}

TEST(ServerHttp, ItsOwnPageMayOpenTheLineAtOnePathOnly) {
  const Stage stage;
  const std::string host = "http://127.0.0.1:" + std::to_string(stage.port);
  for (const std::string& origin : {std::string(), host}) {
    Line line(stage.port);
    (void)line.send(Ask{"GET", "/live", "", test::upgrade_lines(origin)}.text(stage.port));
    const Answer answer(line.receive());
    EXPECT_EQ(answer.status, 101);
    EXPECT_TRUE(answer.has("Sec-WebSocket-Accept: s3pPLMBiTxaQ9kYGzzhZRbK+xOo=")) << answer.head;
  }
  for (const char* target : {"/", "/page.css", "/Live", "/live/", "/live?x=1"}) {
    EXPECT_EQ(ask(stage.port, {"GET", target, "", test::upgrade_lines()}).status, 404) << target;
  }
}

TEST(ServerHttp, GarbageIsNotAnsweredAndHarmsNobody) {
  Stage stage;
  for (const std::string& garbage :
       {std::string("\0\1\2\3\r\n\r\n", 8), std::string(100000, 'x'), std::string("GET\r\n\r\n"),
        std::string("GET / HTTP/9.9\r\n\r\n"), "GET /" + std::string(20000, 'a') + " HTTP/1.1\r\n",
        "GET / HTTP/1.1\r\nHost: 127.0.0.1\r\nX: " + std::string(20000, 'a') + "\r\n\r\n",
        std::string("\x16\x03\x01\x02\x00\x01\x00\x01\xfc", 9) + std::string(500, '\0'),
        std::string("GET / HTTP/1.1\r\nContent-Length: 99999999999999999999\r\n\r\n"),
        std::string("GET / HTTP/1.1\r\nHost\r\n\r\n")}) {
    Line line(stage.port);
    (void)line.send(garbage);
    line.end_sending();
    EXPECT_NE(Answer(line.receive_all()).status, 200);
  }
  stage.expect_alive();
}

// Of two Host or Origin headers only one would have been checked.
TEST(ServerHttp, ASecondHostOrOriginIsForbidden) {
  const Stage stage;
  const std::string own = "127.0.0.1:" + std::to_string(stage.port);
  for (const std::string& more :
       {std::string("Host: evil.example\r\n"), "Host: " + own + "\r\n",
        "Origin: http://" + own + "\r\nOrigin: http://evil.example\r\n"}) {
    EXPECT_NE(ask(stage.port, {"GET", "/", "", more}).status, 200) << more;
    EXPECT_NE(ask(stage.port, {"GET", "/live", "", test::upgrade_lines() + more}).status, 101);
  }
}

// Also on all interfaces: only the local address of the connection is accepted.
TEST(ServerHttp, OnAllInterfacesAForeignAddressIsForbidden) {
  for (const char* address : {"0.0.0.0", "::"}) {
    ServerOptions options;
    options.address = address;
    const Stage stage(options);
    EXPECT_EQ(stage.server->url(), "http://localhost:" + std::to_string(stage.port) + "/");
    const std::string port = ":" + std::to_string(stage.port);
    EXPECT_EQ(ask(stage.port, {"GET", "/", "127.0.0.1" + port}).status, 200) << address;
    EXPECT_EQ(ask(stage.port, {"GET", "/", "localhost" + port}).status, 200) << address;
    for (const char* name : {"8.8.8.8", "10.0.0.7", "0.0.0.0", "127.0.0.2", "[::1]", "[::]"}) {
      EXPECT_EQ(ask(stage.port, {"GET", "/", name + port}).status, 403) << address << name;
      const std::string upgrade = test::upgrade_lines("http://" + (name + port));
      EXPECT_EQ(ask(stage.port, {"GET", "/live", "", upgrade}).status, 403) << address << name;
      EXPECT_EQ(ask(stage.port, {"GET", "/live", name + port, upgrade}).status, 403) << name;
    }
    test::WebPage own(stage.port);
    EXPECT_EQ(own.status(), 101);
  }
}

TEST(ServerHttp, OverIPv6ItIsReachedByItsAddressInBrackets) {
  ServerOptions options;
  options.address = "::1";
  std::unique_ptr<Stage> stage;
  try {
    stage = std::make_unique<Stage>(options);
  } catch (const SetupError& error) {
    GTEST_SKIP() << "no IPv6 on this machine: " << error.what();
  }
  const std::uint16_t port = stage->port;
  const std::string own = "[::1]:" + std::to_string(port);
  EXPECT_EQ(stage->server->url(), "http://" + own + "/");
  const auto status = [&](const Ask& request) {
    Line line = Line::over_ipv6(port);
    (void)line.send(request.text(port));
    return Answer(line.receive()).status;
  };
  EXPECT_EQ(status({"GET", "/", own}), 200);
  EXPECT_EQ(status({"GET", "/live", own, test::upgrade_lines("http://" + own)}), 101);
  EXPECT_EQ(status({"GET", "/", "127.0.0.1:" + std::to_string(port)}), 403);
  EXPECT_EQ(status({"GET", "/", "[::2]:" + std::to_string(port)}), 403);
  const std::string foreign = test::upgrade_lines("http://[::2]:" + std::to_string(port));
  EXPECT_EQ(status({"GET", "/live", own, foreign}), 403);
}

// A hundred clients that send nothing, or half a request, block neither open pages nor new ones.
TEST(ServerHttp, ManyThatSayNothingDoNotKeepANewPageOut) {
  ServerOptions options;
  options.patience = std::chrono::hours(1);
  Stage stage(options);
  test::WebPage page(stage.port);
  std::vector<Line> silent;
  for (int i = 0; i < 100; ++i) {
    silent.emplace_back(stage.port);
    if (i % 2 == 0) (void)silent.back().send("GET / HTTP/1.1\r\nHost: 127");
  }
  stage.expect_pictures(page, 20);
  EXPECT_EQ(ask(stage.port, {}).status, 200);
  stage.expect_alive();
  EXPECT_EQ(silent.front().receive(), "");
  EXPECT_TRUE(silent.front().ended()) << "the oldest has made way";
  EXPECT_EQ(silent.back().receive(std::chrono::milliseconds(100)), "");
  EXPECT_FALSE(silent.back().ended()) << "the newest has not";
}

// A handshake that arrives byte by byte does not extend its timeout.
TEST(ServerHttp, ASlowRequestIsGivenUpHoweverItGoesOn) {
  Stage stage;
  Line line(stage.port);
  (void)line.send("GET / HTTP/1.1\r\nX: ");
  EXPECT_TRUE(eventually([&] {
    (void)line.send("x");
    (void)line.receive(std::chrono::milliseconds(50));
    return line.ended();
  }));
  stage.expect_alive();
}

TEST(ServerHttp, HalfARequestIsGivenUp) {
  Stage stage;
  Line line(stage.port);
  (void)line.send("GET / HTTP/1.1\r\nHost: 127");
  EXPECT_EQ(line.receive(), "");
  EXPECT_TRUE(line.ended());
  stage.expect_alive();
}

TEST(ServerHttp, APortInUseIsNamed) {
  Stage stage;
  ServerOptions options;
  options.port = stage.port;
  FakePageHandler show;
  try {
    const Server second(options, {}, show);
    FAIL() << "two servers on one port";
  } catch (const SetupError& error) {
    const std::string what = error.what();
    EXPECT_NE(what.find("127.0.0.1:" + std::to_string(stage.port)), std::string::npos) << what;
  }
  stage.expect_alive();
}

TEST(ServerHttp, AnAddressThatIsNotOursIsNamed) {
  FakePageHandler show;
  for (const char* address : {"192.0.2.1", "no address", "", "localhost"}) {
    ServerOptions options;
    options.address = address;
    options.port = 0;
    EXPECT_THROW(Server(options, {}, show), SetupError) << address;
  }
}

TEST(ServerHttp, TheUrlIsWhereItListens) {
  Stage stage;
  EXPECT_EQ(stage.server->url(), "http://127.0.0.1:" + std::to_string(stage.port) + "/");
}

TEST(ServerHttp, ItsFilesAreThoseOfAFolder) {
  const test::Folder folder;
  EXPECT_THROW((void)load_assets(folder / "none"), SetupError);
  EXPECT_THROW((void)load_assets(folder / ""), SetupError);
  (void)folder.with("index.html", "<p>");
  (void)folder.with("secret.key", "42");
  test::fs::create_directory(folder / "lib");
  (void)folder.with("lib/a.js", "1");
  std::map<std::string, std::string> types;
  for (const Asset& asset : load_assets(folder / "")) types[asset.target] = asset.media_type;
  EXPECT_EQ(types,
            (std::map<std::string, std::string>{{"/", "text/html; charset=utf-8"},
                                                {"/index.html", "text/html; charset=utf-8"},
                                                {"/lib/a.js", "text/javascript; charset=utf-8"}}));
}

}  // namespace server_http_test
}  // namespace repel::visual
