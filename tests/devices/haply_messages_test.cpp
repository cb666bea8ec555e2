// SPDX-License-Identifier: BSD-3-Clause
#include <repel/devices/haply_messages.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include <devices/fake_haply.hpp>
#include <support/families.hpp>

namespace repel::devices {
namespace haply_messages_test {

using nlohmann::json;

/// What is wrong with the text; empty: nothing.
std::string complaint(const std::string& text) {
  HaplyState state;
  const char* wrong = read_haply(text, state);
  return wrong == nullptr ? "" : wrong;
}

FakeHandle turned() {
  FakeHandle handle;
  handle.velocity = Vec3(0.1, -0.2, 0.3);
  handle.R_DG = Eigen::Quaterniond(Eigen::AngleAxisd(0.5, Vec3::UnitY()));
  handle.buttons = {false, true, false};
  return handle;
}

TEST(HaplyMessages, AStateUpdateIsReadWithItsGrip) {
  const FakeHandle handle = turned();
  HaplyState state;
  ASSERT_EQ(read_haply(state_update(handle).dump(), state), nullptr);
  EXPECT_EQ(state.device_id, "049D");
  EXPECT_EQ(state.position, handle.position);
  EXPECT_EQ(state.velocity, handle.velocity);
  EXPECT_TRUE(state.calibrated);
  EXPECT_TRUE(state.has_grip);
  EXPECT_NEAR(state.R_DG.angularDistance(handle.R_DG), 0.0, 1e-9);
  EXPECT_EQ(state.buttons, handle.buttons);
}

TEST(HaplyMessages, ExtraKeysAreOfNoInterest) {
  json text = state_update(turned());
  text["session_id"] = 7;
  text["inverse3"][0]["config"] = {{"handedness", "right"}, {"preset", "defaults"}};
  text["custom"] = json::array({1, "two", nullptr, {{"x", 1}}});
  EXPECT_EQ(complaint(text.dump()), "");
}

TEST(HaplyMessages, AWiredGripHasOneButton) {
  FakeHandle handle = turned();
  handle.is_wired = true;
  handle.buttons = {true, false, false};
  HaplyState state;
  ASSERT_EQ(read_haply(state_update(handle).dump(), state), nullptr);
  EXPECT_TRUE(state.has_grip);
  EXPECT_EQ(state.buttons, handle.buttons);
}

TEST(HaplyMessages, AServiceMayHaveNoDevice) {
  HaplyState state;
  for (const char* text : {"{}", R"({"inverse3": []})", R"({"session_id": 3})"}) {
    state.device_id = "old";
    ASSERT_EQ(read_haply(text, state), nullptr) << text;
    EXPECT_TRUE(state.device_id.empty());
    EXPECT_FALSE(state.has_grip);
  }
}

TEST(HaplyMessages, WhatIsMissingOrImpossibleIsNamed) {
  const auto without = [](const std::string& path, const json& value) {
    json text = state_update(turned());
    const json::json_pointer at(path);
    if (value.is_null()) {
      text[at.parent_pointer()].erase(at.back());
    } else {
      text[at] = value;
    }
    return complaint(text.dump());
  };
  const std::string position = "the position of the handle is missing or impossible";
  EXPECT_EQ(without("/inverse3/0/state/cursor_position", nullptr), position);
  EXPECT_EQ(without("/inverse3/0/state/cursor_position/y", nullptr), position);
  EXPECT_EQ(without("/inverse3/0/state/cursor_position/y", "0.1"), position);
  EXPECT_EQ(without("/inverse3/0/state/cursor_position/y", 1.5), position);
  EXPECT_EQ(without("/inverse3/0/state", 3), position);
  EXPECT_EQ(without("/inverse3/0/state/cursor_velocity/z", -21.0),
            "the velocity of the handle is missing or impossible");
  EXPECT_EQ(without("/inverse3/0/device_id", nullptr), "a device has no identifier");
  EXPECT_EQ(without("/inverse3/0/device_id", R"(a","b)"), "a device has no identifier");
  EXPECT_EQ(without("/inverse3/0/device_id", std::string(65, 'a')), "a device has no identifier");
  EXPECT_EQ(without("/inverse3/0/status/calibrated", 1), "the status of the handle is none");
  EXPECT_EQ(without("/inverse3", "none"), "the list of devices is none");
  EXPECT_EQ(without("/wireless_verse_grip", "none"), "the list of grips is none");
  EXPECT_EQ(without("/wireless_verse_grip/0/state/orientation/w", nullptr),
            "the orientation of the grip is missing or impossible");
  EXPECT_EQ(without("/wireless_verse_grip/0/state/orientation/w", 0.2),
            "the orientation of the grip is not of length one");
  EXPECT_EQ(without("/wireless_verse_grip/0/state/buttons/a", 0), "a button of the grip is none");
}

TEST(HaplyMessages, WhatIsSaidTwiceOrIsHugeIsNoMessage) {
  json twice = state_update(turned());
  twice["inverse3"].push_back(twice["inverse3"][0]);
  EXPECT_EQ(complaint(twice.dump()), "two devices have the same identifier");
  const std::string no_json = "a message is not JSON, or says something twice";
  std::string text = state_update(turned()).dump();
  EXPECT_EQ(complaint(text.substr(0, text.size() - 1) + R"(,"inverse3":[]})"), no_json);
  EXPECT_EQ(complaint(text.substr(0, text.size() / 2)), no_json);
  EXPECT_EQ(complaint(""), no_json);
  EXPECT_EQ(complaint("[]"), no_json);
  EXPECT_EQ(complaint(std::string(200000, '[')), no_json);
  EXPECT_EQ(complaint(R"({"inverse3": 1e999})"), no_json);
  EXPECT_EQ(complaint(std::string(HaplyBounds::text + 1, ' ')), "a message is too long");
  json many = state_update(turned());
  for (int i = 0; i < 20; ++i) many["inverse3"].push_back({{"device_id", std::to_string(i)}});
  EXPECT_EQ(complaint(many.dump()), "the list of devices is none");
}

/// Changes, removes, repeats or inserts a few bytes.
std::string mutated(std::string text, families::Rng& rng) {
  const std::array<std::string, 10> words{
      "{", "}", "[", "]", "null", "1e9", ",0", "true", "\"inverse3\":", "\\u0000"};
  for (int changes = 1 + static_cast<int>(rng() % 3); changes > 0; --changes) {
    const std::size_t at = rng() % text.size();
    const std::size_t length = std::min<std::size_t>(1 + rng() % 12, text.size() - at);
    switch (rng() % 5) {
      case 0:
        text[at] = static_cast<char>(rng());
        break;
      case 1:
        text.erase(at, length);
        break;
      case 2:
        text.insert(at, text.substr(at, length));
        break;
      case 3:
        text.insert(at, words[rng() % words.size()]);
        break;
      default:
        text[at] = static_cast<char>('0' + rng() % 10);
    }
    if (text.empty()) return " ";
  }
  return text;
}

TEST(HaplyMessages, WhateverIsReadIsWithinBounds) {
  constexpr unsigned seed = 31;
  families::Rng rng(seed);
  SCOPED_TRACE(families::of_seed(seed, "message", 0));
  const std::string sound = state_update(turned()).dump();
  int read = 0, refused = 0;
  for (int i = 0; i < 10000; ++i) {
    const std::string text = mutated(sound, rng);
    HaplyState state;
    if (read_haply(text, state) != nullptr) {
      ++refused;
      continue;
    }
    ++read;
    ASSERT_TRUE(state.position.allFinite() && state.velocity.allFinite()) << text;
    ASSERT_LE(state.position.cwiseAbs().maxCoeff(), HaplyBounds::position) << text;
    ASSERT_LE(state.velocity.cwiseAbs().maxCoeff(), HaplyBounds::velocity) << text;
    ASSERT_NEAR(state.R_DG.norm(), 1.0, 1e-9) << text;
    ASSERT_LE(state.device_id.size(), HaplyBounds::id) << text;
  }
  EXPECT_GT(read, 500);
  EXPECT_GT(refused, 5000);
}

TEST(HaplyMessages, ACommandSaysItsForceAndTheFirstWhoSendsIt) {
  const json first = json::parse(haply_command("049D", Vec3(1.5, -2.25, 0.0), HaplyTurn::first));
  EXPECT_EQ(first["session"]["configure"]["profile"]["name"], "repel");
  EXPECT_EQ(first["session"]["configure"]["basis"]["permutation"], "XYZ");
  const json later = json::parse(haply_command("049D", Vec3(1.5, -2.25, 0.0), HaplyTurn::later));
  EXPECT_EQ(later.size(), 1U);
  for (const json& command : {first, later}) {
    EXPECT_EQ(command["inverse3"][0]["device_id"], "049D");
    EXPECT_EQ(command["inverse3"][0]["commands"]["set_cursor_force"]["values"],
              as_json(Vec3(1.5, -2.25, 0.0)));
  }
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const json zero = json::parse(haply_command("a", Vec3(nan, 1e300, 0.0), HaplyTurn::later));
  EXPECT_EQ(zero["inverse3"][0]["commands"]["set_cursor_force"]["values"]["x"], 0.0);
  const json question = json::parse(haply_command("", Vec3::Zero(), HaplyTurn::first));
  EXPECT_TRUE(question["session"].contains("force_render_full_state"));
}

TEST(HaplyMessages, AnAddressHasAHostAndAPort) {
  EXPECT_EQ(haply_address("ws://localhost")->port, "10001");
  EXPECT_EQ(haply_address("ws://10.0.0.7:99/")->host, "10.0.0.7");
  EXPECT_EQ(haply_address("ws://10.0.0.7:99/")->port, "99");
  EXPECT_EQ(haply_address("ws://[::1]:80")->host, "::1");
  for (const char* wrong : {"", "localhost", "http://localhost", "ws://", "ws://:1", "ws://a:0",
                            "ws://a:65536", "ws://a:1b", "ws://a/path", "ws://[::1", "ws://a b"}) {
    EXPECT_FALSE(haply_address(wrong)) << wrong;
  }
}

}  // namespace haply_messages_test
}  // namespace repel::devices
