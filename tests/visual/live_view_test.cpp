// SPDX-License-Identifier: BSD-3-Clause
// The live view of a program that is not teleop.
#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <map>
#include <string>
#include <thread>

#include <nlohmann/json.hpp>

#include <repel/base/setup_error.hpp>

#include "support/web_page.hpp"
#include "visual/gantry.hpp"

namespace repel::test {
namespace live_view_test {

using Json = nlohmann::json;
using visual::LiveView;
using visual::scene_info_of;

/// A program that ticks while the test reads its pages.
class Program {
 public:
  explicit Program(const visual::ViewOptions& options = free_port()) : view(made(options)) {}

  std::uint16_t port() { return port_of(view.url()); }

  /// Ticks, by the clock, until `page` has received such a message. Null on timeout.
  Json until(WebPage& page, const char* type, const std::function<bool(const Json&)>& such) {
    const auto end = std::chrono::steady_clock::now() + patience;
    while (std::chrono::steady_clock::now() < end) {
      tick();
      const auto text = page.next(std::chrono::milliseconds(0));
      if (!text) continue;
      Json message = Json::parse(*text);
      if (message.at("type") == type && such(message)) return message;
    }
    return {};
  }
  Json until(WebPage& page, const char* type) {
    return until(page, type, [](const Json&) { return true; });
  }
  void tick() {
    // No faster than by the clock, to which the page's silence refers.
    std::this_thread::sleep_for(loop.cell.period());
    const TickRecord& record = loop.step(view);
    State& state = states[record.tick];
    state.record = record;
    loop.cell.coprocessor().for_each_near(
        [&](const NearPair& near) { state.near.emplace(near.pair.index, near); });
  }

  /// The cell after a tick.
  struct State {
    TickRecord record;
    std::map<int, NearPair> near;
  };

  GantryLoop loop;
  std::map<std::int64_t, State> states;
  LiveView view;

 private:
  LiveView made(const visual::ViewOptions& options) {
    visual::SceneInfo info = scene_info_of(loop.cell, "gantry");
    visual::VisualInfo& foot = info.visuals.emplace_back();
    foot.name = "foot";
    foot.body = World::fixed;
    foot.arm = 0;
    foot.X_BV.translation() = Vec3(0.0, 0.0, -1.0);
    foot.color = {0.5, 0.25, 0.0, 1.0};
    foot.mesh = {{{0, 0, 0}, {0.123456789, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
    visual::VisualInfo carriage{.name = "carriage", .arm = 0, .mesh = foot.mesh, .link = 0};
    info.visuals.push_back(std::move(carriage));
    info.arms.front().kinematics = std::make_shared<Gantry>();
    return LiveView(loop.cell, info, options);
  }
};

Json servo(double x) {
  return {{"type", "servo_cv"},
          {"linear", {x, 0, 0}},
          {"angular", {0, 0, 0}},
          {"frame", "world"},
          {"clutch", true}};
}

void expect_vector(const Json& told, const Vec3& is, const char* what) {
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(told.at(i).get<double>(), is[static_cast<Eigen::Index>(i)], 1e-6) << what;
  }
}

bool has_status(const Json& frame, const std::string& word) {
  for (const Json& each : frame.at("status")) {
    if (each == word) return true;
  }
  return false;
}

TEST(LiveView, APageIsToldTheCell) {
  Program program;
  WebPage page(program.port());
  const Json scene = program.until(page, "scene");
  ASSERT_FALSE(scene.is_null());
  EXPECT_EQ(scene.at("name"), "gantry");
  EXPECT_EQ(scene.at("rate_hz"), 1000.0);
  EXPECT_EQ(scene.at("mode"), "live");
  const World& world = program.loop.cell.world();
  EXPECT_EQ(scene.at("parts").size(), world.parts().size());
  EXPECT_EQ(scene.at("pairs").size(), world.pairs().size());
  const Json& arm = scene.at("arms").at(0);
  EXPECT_EQ(arm.at("joints"), Json::parse(R"(["prismatic", "prismatic", "prismatic"])"));
  EXPECT_EQ(arm.at("tool_body"), program.loop.cell.layout(0).tool.index);
  EXPECT_FALSE(arm.at("modules").empty());
  const Json& foot = scene.at("visuals").at(0);
  EXPECT_EQ(foot.at("name"), "foot");
  EXPECT_EQ(foot.at("body"), 0);
  EXPECT_EQ(foot.at("pose"), Json::parse("[0.0, 0.0, -1.0, 0.0, 0.0, 0.0, 1.0]"));
  EXPECT_EQ(foot.at("color"), Json::parse("[0.5, 0.25, 0.0, 1.0]"));
  EXPECT_EQ(foot.at("vertices").at(3), 0.12346) << "rounded to 1e-5 m";
  EXPECT_EQ(foot.at("triangles"), Json::parse("[0, 1, 2]"));
  EXPECT_EQ(scene.at("visuals").at(1).at("link"), 0);
  EXPECT_EQ(arm.at("links"), Json::parse("[0]"));
  const Json who = program.until(page, "operator");
  EXPECT_EQ(who.at("by"), "device");
  EXPECT_EQ(who.at("name"), "The program");
}

TEST(LiveView, AFrameIsTheStateOfTheCellAfterThatTick) {
  Program program;
  program.loop.own.hand.ball.linear = Vec3(0.15, 0.0, 0.0);
  WebPage page(program.port());
  int compared = 0;
  int pairs = 0;
  const std::size_t tool = static_cast<std::size_t>(program.loop.cell.layout(0).tool.index);
  const Json last = program.until(page, "frame", [&](const Json& frame) {
    const auto found = program.states.find(frame.at("tick").get<std::int64_t>());
    if (found == program.states.end()) return false;
    const TickRecord& record = found->second.record;
    ++compared;
    EXPECT_NEAR(frame.at("time_s").get<double>(), record.time, 1e-6);
    const Json& arm = frame.at("arms").at(0);
    expect_vector(arm.at("force"), record.virtual_force.force, "force");
    expect_vector(arm.at("coupling"), record.coupling.force, "coupling");
    expect_vector(arm.at("v"), record.v_WT, "speed");
    expect_vector(frame.at("bodies").at(tool), record.p_WT, "pose of the tool");
    expect_vector(arm.at("links").at(0), Vec3(record.q[0], 0, 0), "pose of a link without a body");
    for (const Json& pair : frame.at("pairs")) {
      const auto near = found->second.near.find(pair.at("i").get<int>());
      EXPECT_NE(near, found->second.near.end());
      if (near == found->second.near.end()) continue;
      ++pairs;
      expect_vector(pair.at("a"), near->second.separation.p_WA, "witness on the arm");
      expect_vector(pair.at("b"), near->second.separation.p_WB, "witness on the obstacle");
      EXPECT_NEAR(pair.at("d").get<double>(), near->second.separation.distance, 1e-6);
      EXPECT_NEAR(pair.at("f").get<double>(), near->second.force, 1e-6);
    }
    return frame.at("pairs").size() > 0 && frame.at("pairs")[0].at("f") > 10.0;
  });
  EXPECT_FALSE(last.is_null()) << "it was led into the wall";
  EXPECT_GT(compared, 5);
  EXPECT_GT(pairs, 0) << "there was nothing to compare";
}

TEST(LiveView, APageDrivesAndASilentOneIsLetGo) {
  Program program;
  WebPage page(program.port());
  ASSERT_FALSE(program.until(page, "scene").is_null());
  EXPECT_FALSE(program.loop.is_driven);
  (void)page.say(servo(0.1).dump());
  EXPECT_EQ(program.until(page, "refused").at("why"), "take the controls first");
  (void)page.say(R"({"type": "pause"})");
  EXPECT_NE(program.until(page, "refused").at("why").get<std::string>().find("driven only"),
            std::string::npos);
  (void)page.say(R"({"type": "take"})");
  ASSERT_FALSE(
      program.until(page, "operator", [](const Json& o) { return o.at("you"); }).is_null());
  const Json moving = program.until(page, "frame", [&](const Json& frame) {
    (void)page.say(servo(0.1).dump());
    return frame.at("arms").at(0).at("v").at(0) > 0.05;
  });
  ASSERT_FALSE(moving.is_null()) << "it follows the page";
  EXPECT_TRUE(program.loop.is_driven);
  // From here on the page says nothing.
  const Json silent = program.until(page, "frame", [](const Json& frame) {
    return has_status(frame, "silent_device") && frame.at("arms").at(0).at("gain") < 0.99;
  });
  ASSERT_FALSE(silent.is_null()) << "the operator's force is taken away";
  EXPECT_TRUE(program.states.rbegin()->second.record.command.hand.ball.linear.isZero(0.0))
      << "and its rates count as zero";
  EXPECT_TRUE(
      program.until(page, "operator", [](const Json& o) { return !o.at("you"); }).at("by") ==
      "device")
      << "and then the program drives again";
  program.tick();
  EXPECT_FALSE(program.loop.is_driven);
}

TEST(LiveView, PagesLookOnUnlessTheProgramLetsThemDrive) {
  Program program(free_port(false));
  WebPage page(program.port());
  ASSERT_FALSE(program.until(page, "scene").is_null());
  (void)page.say(R"({"type": "take"})");
  EXPECT_EQ(program.until(page, "refused").at("why"),
            "The program has the controls: pages look on only");
  EXPECT_FALSE(program.loop.is_driven);
}

TEST(LiveView, PagesComeAndGoWhileTicksGoOn) {
  Program program;
  for (int i = 0; i < 12; ++i) {
    WebPage page(program.port());
    EXPECT_FALSE(program.until(page, "frame").is_null()) << i;
    if (i % 3 == 0) page.close();
    if (i % 3 == 1) page.line().reset();
  }
  EXPECT_EQ(ask(program.port(), {}).status, 200) << "the files of the source tree are found";
}

TEST(LiveView, IsRefusedWithoutASecretWhereOthersReachIt) {
  const auto complaint = [](const std::string& address, const std::string& secret) {
    GantryLoop loop;
    visual::ViewOptions options = free_port();
    options.server.address = address;
    options.server.secret = secret;
    try {
      const LiveView view(loop.cell, scene_info_of(loop.cell, "gantry"), options);
    } catch (const SetupError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(complaint("0.0.0.0", "").find("allowed: 16 or more"), std::string::npos);
  EXPECT_NE(complaint("127.0.0.1", "short").find("5 characters"), std::string::npos);
  EXPECT_EQ(complaint("127.0.0.1", "0123456789abcdef"), "");
  EXPECT_EQ(complaint("0.0.0.0", "0123456789abcdef"), "");
}

TEST(LiveView, WithoutTheFilesOfThePageThereIsNone) {
  GantryLoop loop;
  visual::ViewOptions options = free_port();
  options.page = "/nowhere";
  EXPECT_THROW(LiveView(loop.cell, scene_info_of(loop.cell, "gantry"), options), SetupError);
}

}  // namespace live_view_test
}  // namespace repel::test
