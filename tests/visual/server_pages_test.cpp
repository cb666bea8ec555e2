// SPDX-License-Identifier: BSD-3-Clause
// Open pages must not affect each other.
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>

#include "visual/fake_page_handler.hpp"

namespace repel::visual {
namespace server_pages_test {

using test::Frame;
using test::WebPage;

/// [kB] Resident memory of this program; 0 with a sanitizer, which retains freed memory.
long resident() {
#ifdef REPEL_SANITIZED
  return 0;
#endif
  std::ifstream file("/proc/self/statm");
  long pages = 0;
  file >> pages >> pages;
  return pages * (::sysconf(_SC_PAGESIZE) / 1024);
}

long open_files() {
  const std::filesystem::directory_iterator files("/proc/self/fd");
  return std::distance(begin(files), end(files));
}

TEST(ServerPages, TheShowHearsOfAPageFromItsBeginningToItsEnd) {
  Stage stage;
  WebPage page(stage.port);
  ASSERT_EQ(page.status(), 101);
  EXPECT_EQ(page.next(), "welcome");
  ASSERT_TRUE(page.say("hello"));
  ASSERT_TRUE(page.say(""));
  ASSERT_TRUE(page.send({Frame::text, "in t", false}));
  ASSERT_TRUE(page.send({Frame::ping, "still there?"}));
  ASSERT_TRUE(page.send({Frame::more, "wo parts"}));
  stage.expect_pictures(page, 2);
  page.close();
  EXPECT_EQ(page.close_code(), 1000);
  EXPECT_TRUE(eventually([&] { return stage.show.count("closed") == 1; }));
  EXPECT_EQ(stage.show.of_page(1),
            (std::vector<std::string>{"opened", "hello", "", "in two parts", "closed"}));
}

TEST(ServerPages, AShowThatThrowsInTheThreadOfTheServerEndsNeitherTheProgramNorThePage) {
  testing::internal::CaptureStderr();
  {
    Stage stage;
    WebPage page(stage.port);
    EXPECT_EQ(page.next(), "welcome");
    stage.show.throws = true;
    const std::int64_t before = stage.show.refreshes();
    EXPECT_TRUE(page.say("hello"));
    EXPECT_TRUE(eventually([&] { return stage.show.count("hello") == 1; }));
    EXPECT_TRUE(eventually([&] { return stage.show.refreshes() > before + 3; }));
    stage.show.throws = false;
    stage.expect_pictures(page, 3);
    stage.expect_alive();
  }
  const std::string said = testing::internal::GetCapturedStderr();
  EXPECT_EQ(said, "The live view has failed and goes on: the show fails\n");  // once
}

// A large message is sent in several frames. The client here once forgot those that had come when
// its patience was over, and took the rest for a message.
TEST(ServerPages, AMessageInPiecesArrivesWholeWhoeverReadsImpatiently) {
  Stage stage;
  stage.show.shows = false;
  stage.show.answer_size = 4000000;
  WebPage page(stage.port, "/live", 4096);
  EXPECT_EQ(page.next(), "welcome");
  ASSERT_TRUE(page.say("ask"));
  std::optional<std::string> message;
  int waits = 0;
  while (!message && !page.ended()) {
    message = page.next(std::chrono::milliseconds(0));
    ++waits;
  }
  ASSERT_TRUE(message.has_value());
  EXPECT_EQ(message->size(), 4000000U);
  EXPECT_GT(waits, 1) << "it came at once, so this has shown nothing";
}

TEST(ServerPages, EachHasANumberOfItsOwn) {
  Stage stage;
  for (int i = 0; i < 3; ++i) {
    WebPage page(stage.port);
    EXPECT_EQ(page.next(), "welcome");
    page.close();
  }
  for (int i = 1; i <= 3; ++i) EXPECT_EQ(stage.show.of_page(i).front(), "opened");
}

TEST(ServerPages, NoMoreThanEightAreOpen) {
  Stage stage;
  std::vector<std::unique_ptr<WebPage>> pages;
  for (int i = 0; i < 8; ++i) pages.push_back(std::make_unique<WebPage>(stage.port));
  for (const auto& page : pages) EXPECT_EQ(page->status(), 101);
  EXPECT_EQ(WebPage(stage.port).status(), 503);
  EXPECT_EQ(test::ask(stage.port, {}).status, 200);
  pages.pop_back();
  EXPECT_TRUE(eventually([&] { return WebPage(stage.port).status() == 101; }));
}

/// For any `misuse`, its page is closed with one of `codes` and another continues.
void expect_cut_off(const std::vector<int>& codes, const std::function<void(WebPage&)>& misuse) {
  Stage stage;
  WebPage other(stage.port);
  stage.expect_pictures(other, 1);
  WebPage page(stage.port);
  ASSERT_EQ(page.status(), 101);
  misuse(page);
  const int code = page.await_close();
  EXPECT_NE(std::find(codes.begin(), codes.end(), code), codes.end()) << code;
  stage.expect_pictures(other, 5);
  EXPECT_TRUE(eventually([&] { return stage.show.count("closed") == 1; }));
  EXPECT_TRUE(eventually([&] { return stage.show.open() == 1; }));
}

TEST(ServerPages, AMessageThatIsTooLongCutsItOff) {
  expect_cut_off({1009}, [](WebPage& page) {
    const std::string most(4096, 'm');
    ASSERT_TRUE(page.say(most));
    (void)page.say(most + '+');
  });
}

// The length is announced; the server neither waits for the data nor allocates memory.
TEST(ServerPages, AGigabyteCutsItOffAtOnce) {
  const long before = resident();
  expect_cut_off({1009}, [](WebPage& page) {
    Frame frame{Frame::text, std::string(100000, 'g')};
    frame.announced = 1U << 30U;
    (void)page.send(frame);
  });
  expect_cut_off({1009, 1002}, [](WebPage& page) {
    Frame frame{Frame::text, "g"};
    frame.announced = ~std::uint64_t{0};
    (void)page.send(frame);
  });
  EXPECT_LT(resident() - before, 100000);
}

TEST(ServerPages, PartsThatAddUpToTooMuchCutItOff) {
  expect_cut_off({1009}, [](WebPage& page) {
    for (int i = 0; i < 100; ++i) {
      if (!page.send({i == 0 ? Frame::text : Frame::more, std::string(100, 'f'), false})) return;
    }
  });
}

TEST(ServerPages, FramesThatAreNoneCutItOff) {
  expect_cut_off({1002}, [](WebPage& page) {
    (void)page.send({Frame::text, "bare", true, false});
  });
  expect_cut_off({1002}, [](WebPage& page) { (void)page.send({3, "reserved kind"}); });
  expect_cut_off({1002}, [](WebPage& page) { (void)page.send({Frame::more, "of nothing"}); });
  expect_cut_off({1002}, [](WebPage& page) {
    (void)page.send({Frame::ping, std::string(126, 'p')});
  });
  expect_cut_off({1002}, [](WebPage& page) { (void)page.send({Frame::ping, "part", false}); });
  expect_cut_off({1002}, [](WebPage& page) { (void)page.line().send(std::string(64, '\xff')); });
}

TEST(ServerPages, TextThatIsNoneCutsItOff) {
  for (const char* text : {"\xff", "\xc0\x80", "\xed\xa0\x80", "ends within \xe2\x82"}) {
    expect_cut_off({1007}, [text](WebPage& page) { (void)page.say(text); });
  }
}

TEST(ServerPages, FloodingCutsItOff) {
  expect_cut_off({1008}, [](WebPage& page) {
    for (int i = 0; i < 1000; ++i) {
      if (!page.say("flood")) return;
    }
  });
}

// Parts of the protocol not visible to a reader of messages: pings, pongs, empty fragments.
TEST(ServerPages, FloodingWithFramesThatAreNoMessagesCutsItOff) {
  for (const Frame& frame :
       {Frame{Frame::ping, "p"}, Frame{Frame::ping}, Frame{Frame::pong}, Frame{Frame::text, ""}}) {
    expect_cut_off({1008}, [&](WebPage& page) {
      for (int i = 0; i < 1000; ++i) {
        if (!page.send(frame)) return;
      }
    });
  }
  expect_cut_off({1008}, [](WebPage& page) {
    for (int i = 0; i < 1000; ++i) {
      if (!page.send({i == 0 ? Frame::text : Frame::more, "", false})) return;
    }
  });
}

// No message of a flood is processed after the page was told that it is closed.
TEST(ServerPages, OfAFloodNoMoreIsHeardThanIsAllowed) {
  Stage stage;
  WebPage page(stage.port);
  std::string flood;
  for (int i = 0; i < 2000; ++i) flood += Frame{Frame::text, "flood"}.bytes();
  (void)page.line().send(flood);
  EXPECT_EQ(page.await_close(), 1008);
  EXPECT_TRUE(eventually([&] { return stage.show.count("closed") == 1; }));
  EXPECT_LE(stage.show.count("flood"), 400);
}

TEST(ServerPages, WhatIsAllowedInASecondIsHeard) {
  Stage stage;
  WebPage page(stage.port);
  for (int i = 0; i < 400; ++i) ASSERT_TRUE(page.say("steady"));
  EXPECT_TRUE(eventually([&] { return stage.show.count("steady") == 400; }));
  stage.expect_pictures(page, 1);
}

// Killed, machine gone, or half closed: the end is detected.
TEST(ServerPages, APageThatVanishesIsHeardOf) {
  Stage stage;
  {
    WebPage killed(stage.port);
    stage.expect_pictures(killed, 1);
    killed.line().reset();
    EXPECT_TRUE(eventually([&] { return stage.show.count("closed") == 1; }));
    WebPage gone(stage.port);
    stage.expect_pictures(gone, 1);
    gone.line().close();
    EXPECT_TRUE(eventually([&] { return stage.show.count("closed") == 2; }));
    WebPage half(stage.port);
    stage.expect_pictures(half, 1);
    (void)half.send({Frame::text, "never ", false});
    half.line().end_sending();
    EXPECT_TRUE(eventually([&] { return stage.show.count("closed") == 3; }));
  }
  stage.expect_alive();
}

// Its first frame stays in transit; later ones are not queued for it.
TEST(ServerPages, APageThatNeverReadsHoldsUpNobody) {
  Stage stage;
  WebPage deaf(stage.port, "/live", 4096);
  WebPage other(stage.port);
  stage.show.picture_size = 2000000;
  stage.expect_pictures(other, 10);
  const long before = resident();
  stage.expect_pictures(other, 60);
  EXPECT_LT(resident() - before, 60000);
  stage.show.picture_size = 8;
  deaf.line().end_sending();
  EXPECT_TRUE(eventually([&] { return stage.show.count("closed") == 1; }));
  stage.expect_pictures(other, 2);
}

TEST(ServerPages, APageThatLetsAHundredMessagesWaitIsCutOff) {
  Stage stage;
  WebPage other(stage.port);
  WebPage deaf(stage.port, "/live", 4096);
  stage.show.shows = false;
  stage.show.picture_size = 100000;
  stage.show.tells = true;
  const auto is_cut = [&] {
    (void)other.next(std::chrono::milliseconds(10));
    return stage.show.count("closed") == 1;
  };
  EXPECT_TRUE(eventually(is_cut));
  stage.show.tells = false;
  stage.show.shows = true;
  stage.expect_pictures(other, 2);
}

// It is disconnected because of the answer to its own request: it must count as closed all the
// same.
TEST(ServerPages, APageThatAsksAndNeverReadsIsCutOff) {
  Stage stage;
  stage.show.shows = false;
  stage.show.answer_size = 100000;
  WebPage deaf(stage.port, "/live", 4096);
  for (int i = 0; i < 390 && deaf.say("ask"); ++i) {
  }
  EXPECT_TRUE(eventually([&] { return stage.show.count("closed") == 1; }));
  EXPECT_TRUE(eventually([&] { return stage.show.open() == 0; }));
}

// Clients that have shut down sending and do not read leave nothing behind.
TEST(ServerPages, NothingIsKeptOfAPageThatIsClosed) {
  Stage stage;
  stage.show.picture_size = 8000000;
  const long before = open_files();
  std::vector<std::unique_ptr<WebPage>> pages;
  for (int i = 0; i < 5; ++i) {
    pages.push_back(std::make_unique<WebPage>(stage.port, "/live", 4096));
    EXPECT_EQ(pages.back()->next(), "welcome");
  }
  // Each has a frame in transit that it does not read.
  const std::int64_t refreshes = stage.show.refreshes();
  EXPECT_TRUE(eventually([&] { return stage.show.refreshes() > refreshes + 3; }));
  for (const auto& page : pages) page->line().end_sending();
  EXPECT_TRUE(eventually([&] { return stage.show.count("closed") == 5; }));
  // Of each, only the socket held by this test.
  EXPECT_TRUE(eventually([&] { return open_files() == before + 5; }));
}

TEST(ServerPages, AServerCanEndWithPagesOpen) {
  for (int i = 0; i < 20; ++i) {
    auto stage = std::make_unique<Stage>();
    stage->show.picture_size = i % 2 == 0 ? 8 : 2000000;
    WebPage reads(stage->port);
    const WebPage deaf(stage->port, "/live", 4096);
    test::Line half(stage->port);
    (void)half.send("GET / HT");
    if (i % 3 == 0) stage->expect_pictures(reads, 2);
    for (int k = 0; k < i; ++k) (void)reads.say("more");
    stage.reset();
    (void)reads.await_close();
    EXPECT_TRUE(reads.ended());
  }
}

}  // namespace server_pages_test
}  // namespace repel::visual
