// SPDX-License-Identifier: BSD-3-Clause
// Messages that the project's own page never sends.
#include "visual/live_stage.hpp"

namespace repel::visual {
namespace live_view_abuse_test {

std::string repeated(const std::string& text, int count) {
  std::string all;
  for (int i = 0; i < count; ++i) all += text;
  return all;
}

/// Messages that must be refused in every state.
std::vector<std::string> bad_messages() {
  std::vector<std::string> all{"",
                               " ",
                               "null",
                               "true",
                               "1",
                               "\"take\"",
                               "[]",
                               "{}",
                               "{",
                               "}",
                               "[{\"type\":\"take\"}]",
                               "{\"type\":}",
                               "{\"type\":\"take\"",
                               "{\"type\":\"take\"} {\"type\":\"take\"}",
                               "{'type':'take'}",
                               "{\"type\":\"take\",}",
                               "{type:\"take\"}",
                               "// take\n{\"type\":\"take\"}x",
                               "{\"Type\":\"take\"}",
                               "{\"type\":\"TAKE\"}",
                               "{\"type\":\"take \"}",
                               "{\"type\":null}",
                               "{\"type\":1}",
                               "{\"type\":[\"take\"]}",
                               "{\"type\":{\"type\":\"take\"}}",
                               "{\"type\":\"\\ud800\"}",
                               "{\"type\":\"take\\u0000\"}",
                               "{\"type\":\"\xff\"}",
                               "{\"type\":\"\xc3\x28\"}",
                               "{\"type\":\"\xed\xa0\x80\"}",
                               "{\"type\":1e999}",
                               "{\"type\":\"step\",\"ticks\":1e999}",
                               "{\"type\":\"step\",\"ticks\":NaN}",
                               "{\"type\":\"step\",\"ticks\":Infinity}",
                               "{\"type\":\"step\"}",
                               "{\"type\":\"step\",\"ticks\":true}",
                               "{\"type\":\"take\",\"type\":\"nothing\"}",
                               std::string("\0", 1)};
  for (const char* open : {"[", "{\"type\":", "{\"a\":[", "\"", "-", "9", "\\", "\xe2"}) {
    all.push_back(repeated(open, 4096 / static_cast<int>(std::string(open).size())));
  }
  all.push_back("{\"type\":" + repeated("[", 2000) + repeated("]", 2000) + "}");
  all.push_back("{\"type\":\"" + repeated("x", 4000) + "\"}");
  return all;
}

/// Messages of a driver that must be refused.
std::vector<Json> bad_commands() {
  std::vector<Json> all;
  const Json good = servo(0.1, 0, 0);
  const Json lever{{"type", "servo_lever"}, {"direction", {1, 0, 0}}, {"rate", 0.5}};
  const auto with = [&](const Json& base, const char* key, const Json& value) {
    all.push_back(base);
    all.back()[key] = value;
  };
  for (const Json& bad :
       {Json(nullptr), Json(1), Json("1"), Json::array(), Json{1, 2}, Json{1, 2, 3, 4},
        Json{1, 2, "3"}, Json{1, nullptr, 3}, Json{1, 2, true}, Json{{0}, {0}, {0}},
        Json{1e308, 1e308, 1e308}, Json{1e4, 0, 0}, Json::object()}) {
    with(good, "linear", bad);
    with(good, "angular", bad);
    with(lever, "direction", bad);
  }
  for (const Json& frame : {Json("World"), Json(""), Json(nullptr), Json(0), Json{"world"}}) {
    with(good, "frame", frame);
  }
  for (const Json& rate : {Json(101), Json(-1e300), Json("1"), Json(nullptr), Json{1}}) {
    with(lever, "rate", rate);
  }
  with(lever, "direction", {0, 0, 0});
  with(lever, "direction", {1e-300, 0, 0});
  for (const char* key : {"linear", "angular", "frame"}) {
    all.push_back(good);
    all.back().erase(key);
  }
  return all;
}

TEST(LiveShowAbuse, EveryBadMessageIsAnsweredAndIgnored) {
  for (const bool driving : {false, true}) {
    LiveStage stage;
    if (driving) {
      EXPECT_EQ(stage.say(1, Json{{"type", "take"}}), "");
      EXPECT_TRUE(stage.posted());
    }
    for (const std::string& message : bad_messages()) {
      EXPECT_NE(stage.say(1, message), "") << message.substr(0, 60);
      EXPECT_FALSE(stage.posted()) << message.substr(0, 60);
    }
    EXPECT_FALSE(stage.controls.paused);
    EXPECT_FALSE(stage.controls.restart);
    EXPECT_EQ(stage.controls.steps, 0);
    EXPECT_EQ(stage.say(1, Json{{"type", "take"}}), "");
  }
}

TEST(LiveShowAbuse, EveryBadCommandIsAnsweredAndIgnored) {
  LiveStage stage;
  (void)stage.say(1, Json{{"type", "take"}});
  EXPECT_TRUE(stage.posted());
  for (const Json& message : bad_commands()) {
    EXPECT_NE(stage.say(1, message), "") << message;
    EXPECT_FALSE(stage.posted()) << message;
  }
  for (const char* number : {"1e999", "-1e999", "NaN", "Infinity", "0x1", "01", "1.", ".5", "+1"}) {
    std::string text =
        "{\"type\":\"servo_cv\",\"angular\":[0,0,0],\"frame\":\"world\",\"linear\":[0,";
    text += number;
    text += ",0],\"clutch\":true}";
    EXPECT_NE(stage.say(1, text), "") << number;
    EXPECT_FALSE(stage.posted()) << number;
  }
}

TEST(LiveShowAbuse, OfKeysThatComeTwiceOneCounts) {
  LiveStage stage;
  EXPECT_EQ(stage.say(1, std::string("{\"type\":\"pause\",\"type\":\"take\"}")), "");
  EXPECT_FALSE(stage.controls.paused);
  EXPECT_TRUE(stage.posted());
  EXPECT_EQ(stage.say(1, std::string("{\"type\":\"servo_cv\",\"linear\":[9999,0,0],\"linear\":[0.1,"
                                     "0,0],\"angular\":[0,0,0],\"frame\":\"world\",\"clutch\":true"
                                     "}")),
            "");
  ASSERT_TRUE(stage.posted());
  EXPECT_EQ(stage.input().rates.linear, Vec3(0.1, 0, 0));
}

TEST(LiveShowAbuse, PagesThatAreNotThereHarmNobody) {
  LiveStage stage;
  stage.show.closed(99, stage.pages);
  EXPECT_NE(stage.say(99, Json{{"type", "take"}}), "");
  EXPECT_FALSE(stage.posted());
  stage.show.closed(99, stage.pages);
  EXPECT_EQ(stage.say(1, Json{{"type", "take"}}), "");
}

}  // namespace live_view_abuse_test
}  // namespace repel::visual
