// SPDX-License-Identifier: BSD-3-Clause
// A server reachable from other machines: who may watch, and who may control.
#include "visual/fake_page_handler.hpp"

namespace repel::visual {
namespace server_secret_test {

using test::Frame;
using test::Line;
using test::WebPage;

const std::string secret = "correct horse battery";

std::string presenting(const std::string& text) {
  return R"({"type": "secret", "secret": ")" + text + "\"}";
}

/// A server that requires a secret and listens on all interfaces.
struct SecretStage : Stage {
  explicit SecretStage(ServerOptions options = {}) : Stage(with_secret(options)) {}
  static ServerOptions with_secret(ServerOptions options) {
    options.address = "0.0.0.0";
    options.secret = secret;
    return options;
  }
  /// A page that knows it and receives frames.
  void expect_alive() {
    WebPage page(port);
    ASSERT_EQ(page.status(), 101);
    ASSERT_TRUE(page.say(presenting(secret)));
    expect_pictures(page, 3);
    page.close();
  }
};

TEST(ServerSecret, WhoPresentsItLooksOnAndDrives) {
  SecretStage stage;
  WebPage page(stage.port);
  ASSERT_EQ(page.status(), 101);
  EXPECT_EQ(page.next(), R"({"type":"secret"})") << "it is asked for";
  ASSERT_TRUE(page.say(presenting(secret)));
  EXPECT_EQ(page.next(), "welcome");
  ASSERT_TRUE(page.say("hello"));
  stage.expect_pictures(page, 2);
  page.close();
  EXPECT_TRUE(eventually([&] { return stage.show.count("closed") == 1; }));
  EXPECT_EQ(stage.show.of_page(1), (std::vector<std::string>{"opened", "hello", "closed"}));
}

// It receives no frame, and none of its messages reaches the page handler.
TEST(ServerSecret, WhoDoesNotKnowItSeesAndDoesNothing) {
  for (const std::string& first :
       {std::string("hello"), std::string(), presenting(""), presenting(secret.substr(1)),
        presenting(secret + "!"), std::string(R"({"type": "take"})"), "\"" + secret + "\"",
        std::string(R"({"type": "secret"})"), std::string(R"({"type": "secret", "secret": 1})"),
        std::string(4000, '[')}) {
    SecretStage stage;
    WebPage page(stage.port);
    EXPECT_EQ(page.next(), R"({"type":"secret"})");
    (void)page.say(first);
    (void)page.say("and more");
    EXPECT_EQ(page.next(), std::nullopt) << first;
    EXPECT_EQ(page.close_code(), 4401) << first;
    EXPECT_EQ(stage.show.open(), 0);
    EXPECT_EQ(stage.show.count("opened") + stage.show.count("closed"), 0);
    EXPECT_EQ(stage.show.count("and more"), 0);
    stage.expect_alive();
  }
}

TEST(ServerSecret, WhoSaysNothingIsSentAway) {
  SecretStage stage;
  WebPage page(stage.port);
  EXPECT_EQ(page.await_close(), 4401);
  stage.expect_alive();
}

TEST(ServerSecret, WhoGuessesHasToWait) {
  SecretStage stage;
  int codes[2] = {0, 0};
  for (int i = 0; i < 8; ++i) {
    WebPage page(stage.port);
    (void)page.say(presenting("guess number " + std::to_string(i)));
    const int code = page.await_close();
    ASSERT_TRUE(code == 4401 || code == 4429) << code;
    ++codes[code == 4429 ? 1 : 0];
  }
  EXPECT_GE(codes[0], 5);
  EXPECT_GT(codes[1], 0) << "it is not compared any more";
  // In the end a client that knows it is admitted.
  EXPECT_TRUE(eventually([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    WebPage page(stage.port);
    (void)page.say(presenting(secret));
    (void)page.next();
    return page.next() == "welcome";
  }));
}

TEST(ServerSecret, AProgramThatIsNoBrowserDrivesWithItToo) {
  SecretStage stage;
  WebPage program(Line(stage.port),
                  test::Ask{"GET", "/live", "", test::upgrade_lines()}.text(stage.port));
  ASSERT_EQ(program.status(), 101);
  (void)program.say(presenting(secret));
  stage.expect_pictures(program, 2);
  EXPECT_EQ(stage.show.of_page(1).front(), "opened");
}

TEST(ServerSecret, APageOfAnotherOriginIsRefusedWhateverItKnows) {
  SecretStage stage;
  const std::string port = std::to_string(stage.port);
  for (const std::string& origin : {"http://10.0.0.7:" + port, "http://localhost:" + port}) {
    EXPECT_EQ(test::ask(stage.port, {"GET", "/live", "", test::upgrade_lines(origin)}).status, 403);
  }
}

// The page itself reveals nothing of the scene; without it no secret could be entered.
TEST(ServerSecret, ThePageItselfIsForEverybody) {
  SecretStage stage;
  const test::Answer page = test::ask(stage.port, {});
  EXPECT_EQ(page.status, 200);
  EXPECT_EQ(page.body.find(secret), std::string::npos);
}

// Clients that have connected and send nothing take no page's slot.
TEST(ServerSecret, ManyThatDoNotPresentItDoNotKeepAPageOut) {
  ServerOptions options;
  options.patience = std::chrono::hours(1);
  SecretStage stage(options);
  std::vector<std::unique_ptr<WebPage>> silent;
  for (int i = 0; i < 80; ++i) silent.push_back(std::make_unique<WebPage>(stage.port));
  stage.expect_alive();
  EXPECT_EQ(silent.front()->await_close(), 0);
  EXPECT_TRUE(silent.front()->ended()) << "the oldest has made way";
}

TEST(ServerSecret, NoMorePagesThanOtherwise) {
  SecretStage stage;
  std::vector<std::unique_ptr<WebPage>> pages;
  for (int i = 0; i < 8; ++i) {
    pages.push_back(std::make_unique<WebPage>(stage.port));
    (void)pages.back()->say(presenting(secret));
    stage.expect_pictures(*pages.back(), 1);
  }
  EXPECT_EQ(WebPage(stage.port).status(), 503);
  pages.pop_back();
  EXPECT_TRUE(eventually([&] { return WebPage(stage.port).status() == 101; }));
}

TEST(ServerSecret, AServerCanEndWhileItIsAskedFor) {
  for (int i = 0; i < 10; ++i) {
    auto stage = std::make_unique<SecretStage>();
    WebPage asked(stage->port);
    EXPECT_TRUE(asked.next().has_value());
    if (i % 2 == 0) (void)asked.say(presenting(i % 4 == 0 ? secret : "wrong"));
    stage.reset();
    (void)asked.await_close();
    EXPECT_TRUE(asked.ended());
  }
}

// On this machine, without a secret: a browser always sends the origin of a WebSocket.
TEST(ServerSecret, WithoutOneAProgramThatNamesNoOriginLooksOn) {
  Stage stage;
  WebPage program(Line(stage.port),
                  test::Ask{"GET", "/live", "", test::upgrade_lines()}.text(stage.port));
  ASSERT_EQ(program.status(), 101);
  stage.expect_pictures(program, 2);
  EXPECT_EQ(stage.show.of_page(1).front(), "looks on");
  WebPage page(stage.port);
  stage.expect_pictures(page, 1);
  EXPECT_EQ(stage.show.of_page(2).front(), "opened");
}

}  // namespace server_secret_test
}  // namespace repel::visual
