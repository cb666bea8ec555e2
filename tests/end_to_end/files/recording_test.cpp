// SPDX-License-Identifier: BSD-3-Clause
// Recording and replay of runs, as done by a user.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include <repel/record/mcap_reader.hpp>

#include "end_to_end/rewriting.hpp"
#include "end_to_end/teleop.hpp"

namespace repel::test {
namespace recording_test {

/// Records a run of `arguments` to `file`.
void record(const std::string& arguments, const std::string& file) {
  const Ending ending = teleop(arguments + " --log " + quoted(file));
  ASSERT_EQ(ending.status, 0) << ending;
}

/// The "replay" entry of the report of a replay of the file.
nlohmann::json replay(const std::string& file, int status = 0) {
  const Folder folder;
  const Ending ending =
      teleop("replay " + quoted(file) + " --report " + quoted(folder / "report.json"));
  EXPECT_EQ(ending.status, status) << ending;
  return report_of(folder / "report.json").at("replay");
}

TEST(Recording, ReplayHasTheSameForcesBitForBit) {
  const Folder folder;
  const std::string file = folder / "run.mcap";
  for (const std::string arguments :
       {"anderson_4x8 --fast --seconds 20", "anderson_4x8 --seconds 3 --threads 0",
        "two_arms --fast --seconds 6 --backend ode", "conveyor --fast --seconds 6",
        "delayed --fast --seconds 3 --threads 2 --backend ideal"}) {
    SCOPED_TRACE(arguments);
    record(arguments, file);
    const auto result = replay(file);
    EXPECT_GE(result.at("ticks"), arguments.find("--fast") == std::string::npos ? 100 : 1200);
    EXPECT_EQ(result.at("same"), result.at("ticks"));
    EXPECT_EQ(result.at("first_difference"), -1);
  }
}

// A device that stops sending, a hand that sends NaN, a budget that is exhausted: all are
// reproduced.
TEST(Recording, FaultsAndBudgetsComeAgain) {
  const Folder folder;
  const std::string file = folder / "run.mcap";
  const std::string script =
      "script:\n"
      "  - {name: push, device: spaceball, duration: 1 s, linear: 0 0 -100 mm/s}\n"
      "  - {name: lost, device: spaceball, duration: 500 ms, silent: yes}\n"
      "  - {name: back, device: spaceball, duration: 2 s, linear: 0 0 50 mm/s}\n"
      "budget: {work: 1}\n";
  const std::string scene = folder.with("scene.yaml", robot_text() + table_text() + script);
  record(quoted(scene) + " --fast --seconds 4", file);
  const auto result = replay(file);
  EXPECT_EQ(result.at("ticks"), 1600);
  EXPECT_EQ(result.at("same"), 1600);
}

/// Reads the messages of a topic.
std::vector<nlohmann::json> messages_of(const std::string& file, const std::string& topic) {
  record::McapReader reader(file);
  std::vector<nlohmann::json> all;
  record::McapMessage message;
  while (reader.next(message)) {
    if (reader.channels().at(message.channel).topic == topic)
      all.push_back(nlohmann::json::parse(message.data));
  }
  return all;
}

TEST(Recording, EveryChannelHasItsTicks) {
  const Folder folder;
  const std::string file = folder / "run.mcap";
  record("anderson_4x8 --fast --seconds 2", file);
  for (const std::string topic : {"/inputs", "/forces", "/separations", "/energy", "/timing"}) {
    const auto messages = messages_of(file, topic);
    ASSERT_EQ(messages.size(), 800U) << topic;
    for (std::size_t i = 0; i < messages.size(); ++i) ASSERT_EQ(messages[i].at("tick"), i) << topic;
  }
  double peak = 0.0;
  std::size_t near = 0;
  for (const auto& forces : messages_of(file, "/forces")) {
    peak = std::max(peak, forces.at("arms").at(0).at("force_n").get<double>());
  }
  for (const auto& separations : messages_of(file, "/separations")) {
    near += separations.at("pairs").size();
  }
  EXPECT_GT(peak, 10.0);
  EXPECT_GT(near, 800U);
  const auto poses = messages_of(file, "/poses");
  ASSERT_EQ(poses.size(), 200U);
  EXPECT_EQ(poses.front().at("transforms").at(0).at("child_frame_id"), "tool");
}

// As after a crash: the existing part can be replayed, and is reported as incomplete.
TEST(Recording, ATableHasRatesAndTimesAndNoNumberThatIsNone) {
  const Folder folder;
  // Nothing is near in its first second.
  record("plates --fast --seconds 1", folder / "fast.csv");
  record("plates --seconds 1", folder / "clock.csv");
  for (const char* name : {"fast.csv", "clock.csv"}) {
    SCOPED_TRACE(name);
    const std::string text = text_of(folder / name);
    EXPECT_NE(text.find(",nearest_m,"), std::string::npos);
    EXPECT_NE(text.find(",compute_us,late_us\n"), std::string::npos);
    EXPECT_EQ(text.find(",inf"), std::string::npos);
    EXPECT_EQ(text.find("nan,"), std::string::npos);
    const Columns log = columns_of(folder / name);
    EXPECT_TRUE(std::isnan(log.at("nearest_m").front())) << log.at("nearest_m").front();
    EXPECT_EQ(std::isnan(log.at("compute_us").back()), name == std::string("fast.csv"));
    EXPECT_EQ(std::isnan(log.at("late_us").back()), name == std::string("fast.csv"));
    double fastest = 0.0;
    for (std::size_t i = 1; i < log.at("tick").size(); ++i) {
      const double moved = log.at("q2_rad")[i] - log.at("q2_rad")[i - 1];
      const double rate = log.at("v2_rad_s")[i];
      fastest = std::max(fastest, std::abs(rate));
      if (log.at("tick")[i] == log.at("tick")[i - 1] + 1.0) {
        EXPECT_NEAR(moved, 0.0025 * rate, 2e-4);
      }
    }
    EXPECT_GT(fastest, 0.01);
  }
}

TEST(Recording, FileThatIsCutOffReplaysUpToThere) {
  const Folder folder;
  const std::string file = folder / "run.mcap";
  record("anderson_4x8 --fast --seconds 4", file);
  std::filesystem::resize_file(file, std::filesystem::file_size(file) / 2);
  const Ending ending = teleop("replay " + quoted(file));
  EXPECT_EQ(ending.status, 0) << ending;
  EXPECT_TRUE(ending.says("ends early")) << ending;
  const auto result = replay(file);
  EXPECT_GT(result.at("ticks"), 400);
  EXPECT_LT(result.at("ticks"), 1400);
  EXPECT_EQ(result.at("same"), result.at("ticks"));
}

// Killed: there is no time to finish the file.
TEST(Recording, RunThatIsKilledLeavesWhatItHadWritten) {
  const Folder folder;
  const std::string file = folder / "run.mcap";
  const Ending ending = shell("$T anderson_4x8 --log " + quoted(file) + " & holds " +
                              quoted(file + ".part") + " 400000; kill -KILL $!; wait $!");
  ASSERT_EQ(ending.status, 137) << ending;
  const auto result = replay(file + ".part");
  EXPECT_GT(result.at("ticks"), 400);
  EXPECT_EQ(result.at("same"), result.at("ticks"));
}

/// Copies the recording with `before` in its scene replaced by `after`.
void rewrite_scene(const std::string& from, const std::string& to, const std::string& before,
                   const std::string& after) {
  rewrite(from, to, {.attachment = [&](std::string& data) {
            const std::size_t at = data.find(before);
            if (at != std::string::npos) data.replace(at, before.size(), after);
          }});
}

// With a different wall, the recorded forces cannot be reproduced.
TEST(Recording, ReplayThatDiffersIsSaidAndCounted) {
  const Folder folder;
  const std::string file = folder / "run.mcap";
  const std::string scene = folder.with("scene.yaml", robot_text() + table_text() + push_text());
  record(quoted(scene) + " --fast --seconds 2", file);
  rewrite_scene(file, folder / "same.mcap", "no such words", "");
  EXPECT_EQ(replay(folder / "same.mcap").at("same"), 800);
  rewrite_scene(file, folder / "other.mcap", "surface_force: 40 N", "surface_force: 41 N");
  const auto result = replay(folder / "other.mcap", 3);
  EXPECT_GT(result.at("same"), 20) << "before the table is felt";
  EXPECT_LT(result.at("same"), 800);
  EXPECT_EQ(result.at("first_difference"), result.at("same"));
  EXPECT_GT(result.at("force_difference_n"), 0.1);
}

TEST(Recording, WhatIsNoRecordingIsRefusedByName) {
  const Folder folder;
  const std::string text = folder.with("text.mcap", "no recording at all, but long enough to read");
  for (const std::string& file : {text, folder / "absent.mcap"}) {
    const Ending ending = teleop("replay " + quoted(file));
    EXPECT_EQ(ending.status, 1) << ending;
    EXPECT_TRUE(ending.says(file)) << ending;
  }
  EXPECT_EQ(teleop("replay " + quoted(text) + " --seconds 3").status, 2);
  EXPECT_EQ(teleop("plates --log " + quoted(folder / "no/such.mcap")).status, 1);
}

TEST(Recording, AnotherRobotIsRefused) {
  const Folder folder;
  const std::string urdf = folder.with("arm.urdf", text_of(REPEL_SOURCE "/robots/puma560.urdf"));
  const std::string scene =
      folder.with("scene.yaml", robot_text(urdf) + table_text() + push_text());
  record(quoted(scene) + " --fast --seconds 1", folder / "run.mcap");
  std::ofstream(urdf, std::ios::app) << "<!-- changed -->\n";
  const Ending ending = teleop("replay " + quoted(folder / "run.mcap"));
  EXPECT_EQ(ending.status, 1) << ending;
  EXPECT_TRUE(ending.says("arm.urdf")) << ending;
}

/// A recording has the convex parts of the meshes of its scene: without them it would be gone
/// through again in another world.
TEST(Recording, OtherPartsOfAMeshAreRefused) {
  const Folder folder;
  (void)folder.with("table.stl", "a mesh that nothing reads here");
  const std::string parts =
      "parts:\n  - points:\n"
      "      - 0.3 -0.4 0 m\n      - -0.3 -0.4 0 m\n      - 0.3 0.4 0 m\n      - -0.3 0.4 0 m\n"
      "      - 0.3 -0.4 -0.05 m\n      - -0.3 -0.4 -0.05 m\n      - 0.3 0.4 -0.05 m\n"
      "      - -0.3 0.4 -0.05 m\n";
  const std::string list = folder.with("table.stl.parts.yaml", parts);
  const std::string obstacles =
      "laws:\n  default: {range: 20 mm, surface_force: 40 N, damping: 1 N s/m}\n"
      "obstacles:\n"
      "  - {name: table, shape: mesh, file: table.stl, position: 0.6 -0.15 0.45 m}\n";
  const std::string scene = folder.with("scene.yaml", robot_text() + obstacles + push_text());
  record(quoted(scene) + " --fast --seconds 1", folder / "run.mcap");
  const Ending same = teleop("replay " + quoted(folder / "run.mcap"));
  EXPECT_EQ(same.status, 0) << same;
  EXPECT_TRUE(same.says("table/1")) << same;
  std::ofstream(list, std::ios::app) << "      - 0 0 1 m\n";
  const Ending other = teleop("replay " + quoted(folder / "run.mcap"));
  EXPECT_EQ(other.status, 1) << other;
  EXPECT_TRUE(other.says("table.stl.parts.yaml")) << other;
}

}  // namespace recording_test
}  // namespace repel::test
