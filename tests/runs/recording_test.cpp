// SPDX-License-Identifier: BSD-3-Clause
// What a recording keeps of the operator, bit for bit.

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <random>

#include <nlohmann/json.hpp>

#include <end_to_end/folder.hpp>
#include <repel/record/mcap_reader.hpp>
#include <repel/record/mcap_writer.hpp>
#include <repel/runs/records/mcap_log.hpp>
#include <repel/runs/records/mcap_names.hpp>
#include <repel/runs/records/recording.hpp>
#include <repel/runs/setup/prepared_run.hpp>

namespace repel::runs {
namespace recording_test {

using network::Command;
using network::HandInput;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

std::string scene_file(const std::string& /*name*/) {
  return REPEL_SOURCE "/scenes/empty.yaml";
}

RunOptions options() {
  RunOptions options;
  options.fast = true;
  options.rate_hz = 400.0;
  return options;
}

/// A log of a run of the scene `empty` in which these were the ticks.
void record(const std::string& path, const std::vector<TickRecord>& ticks) {
  const auto prepared = prepare(scene::load(scene_file("empty")), options());
  const World& world = prepared->cell.world();
  BesideTicks beside;
  const auto log = mcap_log(path, heading_of(prepared->scene, prepared->cell), prepared->scene,
                            options(), prepared->cell, prepared->shown, beside);
  Snapshot snapshot;
  snapshot.arms.resize(1);
  snapshot.X_WB.assign(world.motion().bodies.size(), Pose::Identity());
  snapshot.is_there.assign(world.motion().bodies.size(), 1);
  std::int64_t number = 0;
  for (const TickRecord& tick : ticks) {
    snapshot.arms.front() = tick;
    snapshot.arms.front().tick = number++;
    log->write(snapshot);
  }
  log->close(0);
}

/// Likewise, in which these were the commands.
void record(const std::string& path, const std::vector<Command>& commands) {
  std::vector<TickRecord> ticks(commands.size());
  for (std::size_t i = 0; i < ticks.size(); ++i) ticks[i].command = commands[i];
  record(path, ticks);
}

std::vector<Command> commands_in(const std::string& path) {
  const Recording recording = load_recording(path, scene_file);
  std::vector<Command> commands;
  for (const TickRecord& tick : recording.arms.front()) {
    commands.push_back(tick.command);
  }
  return commands;
}

/// All numbers of a hand, under their names.
std::vector<std::pair<std::string, double>> numbers_of(const HandInput& hand) {
  std::vector<std::pair<std::string, double>> all;
  network::for_each_field(
      [&all](const network::HandField& field, const auto& x) {
        if constexpr (std::is_arithmetic_v<std::remove_cvref_t<decltype(x)>>) {
          all.emplace_back(field.name, static_cast<double>(x));
        } else {
          for (const double each : x) all.emplace_back(field.name, each);
        }
      },
      hand);
  return all;
}

/// A NaN is the same as any other.
void expect_same(const HandInput& then, const HandInput& now, const std::string& which) {
  const auto a = numbers_of(then);
  const auto b = numbers_of(now);
  for (std::size_t i = 0; i < a.size(); ++i) {
    const auto& [name, x] = a[i];
    const double y = b[i].second;
    const bool same = std::isnan(x)
                          ? std::isnan(y)
                          : std::bit_cast<std::uint64_t>(x) == std::bit_cast<std::uint64_t>(y);
    EXPECT_TRUE(same) << which << ", " << name << ": " << x << " became " << y;
  }
}

/// Each number is, as often as not, that of no hand.
HandInput some_hand(std::mt19937_64& rng, bool is_sound) {
  std::normal_distribution<double> normal;
  HandInput hand;
  const auto draw = [&](double& x) {
    if (rng() % 2 == 0) return;
    x = normal(rng);
    if (rng() % 8 == 0) x = -0.0;
    if (!is_sound && rng() % 4 == 0) x = std::array{nan, infinity, -infinity}[rng() % 3];
  };
  network::for_each_field(
      [&](const network::HandField& /*field*/, auto& x) {
        using Value = std::remove_cvref_t<decltype(x)>;
        if constexpr (std::is_same_v<Value, double>) {
          draw(x);
        } else if constexpr (std::is_same_v<Value, Vec3>) {
          for (double& each : x) draw(each);
        } else if (rng() % 2 == 0) {
          x = static_cast<Value>(rng() % 128);
        }
      },
      hand);
  return hand;
}

// Of a second hand there once were four numbers of nine, and the scale of the first.
TEST(RecordedCommands, AreThoseOfBothHandsEachWithItsOwnScale) {
  constexpr unsigned seed = 14;
  std::mt19937_64 rng(seed);
  std::vector<Command> commands(400);
  for (std::size_t i = 0; i < commands.size(); ++i) {
    const bool is_sound = i % 4 != 3;
    if (i % 5 != 0) commands[i].hand = some_hand(rng, is_sound);
    if (i % 7 != 0) commands[i].second = some_hand(rng, is_sound);
    commands[i].silent_for = std::array{0.0, 0.25, is_sound ? 1.0 : infinity}[i % 3];
    commands[i].sound = i % 2 == 0;
  }
  const test::Folder folder;
  record(folder / "run.mcap", commands);
  const std::vector<Command> now = commands_in(folder / "run.mcap");
  ASSERT_EQ(now.size(), commands.size());
  for (std::size_t i = 0; i < commands.size(); ++i) {
    SCOPED_TRACE("seed " + std::to_string(seed) + ", tick " + std::to_string(i));
    expect_same(commands[i].hand, now[i].hand, "first hand");
    expect_same(commands[i].second, now[i].second, "second hand");
    EXPECT_EQ(commands[i].sound, now[i].sound);
    EXPECT_EQ(commands[i].silent_for, now[i].silent_for);
  }
}

/// The recording at `path`, rewritten with other inputs of the first arm.
void rewrite(const std::string& path, const std::function<void(nlohmann::json&)>& change) {
  record::McapReader reader(path);
  const std::string changed = path + ".old.mcap";
  record::McapWriter writer(changed, {});
  for (const auto& each : reader.metadata()) writer.add_metadata(each.name, each.entries);
  for (const auto& each : reader.attachments()) writer.attach(each.name, "", each.data, 0);
  std::map<std::uint16_t, std::uint16_t> channels;
  for (const auto& [id, channel] : reader.channels()) {
    const auto schema = writer.add_schema(channel.topic, "jsonschema", "{}");
    channels[id] = writer.add_channel(channel.topic, schema, "json");
  }
  record::McapMessage message;
  for (std::uint32_t i = 0; reader.next(message); ++i) {
    nlohmann::json json = nlohmann::json::parse(message.data);
    if (reader.channels().at(message.channel).topic == mcap::inputs.topic) {
      change(json.at("arms").at(0));
    }
    writer.write(channels.at(message.channel), i, i, json.dump());
  }
  writer.close();
  test::fs::rename(changed, path);
}

/// Another value than it had.
void change(double& x, double& next) {
  x = next += 0.125;
}
void change(bool& x, double& /*next*/) {
  x = !x;
}
void change(Vec3& v, double& next) {
  for (double& x : v) change(x, next);
}
void change(JointNumbers& numbers, double& next) {
  for (std::size_t i = 0; i < 6; ++i) change(numbers[i], next);
}

TEST(RecordedForces, AreAllThatHaveAnEntry) {
  const test::Folder folder;
  TickRecord told;
  double next = 0.0;
  int entries = 0;
  const auto has_entry = [](const TickField& field) { return *field.entry != '\0'; };
  for_each_field(
      [&](const TickField& field, auto& x) {
        if (!has_entry(field)) return;
        ++entries;
        if constexpr (requires { change(x, next); }) change(x, next);
      },
      told);
  record(folder / "run.mcap", std::vector<TickRecord>{told});
  const Recording recording = load_recording(folder / "run.mcap", scene_file);
  for_each_field(
      [&](const TickField& field, const auto& x, const auto& now) {
        if constexpr (!std::is_same_v<std::remove_cvref_t<decltype(x)>, Wrench>) {
          if (has_entry(field)) {
            EXPECT_EQ(x, now) << field.entry;
          }
        }
      },
      told, recording.arms.front().front());
  EXPECT_GE(entries, 10);
}

TEST(RecordedCommands, OfOlderRecordingsAreReadAsTheyWereMeant) {
  const test::Folder folder;
  const std::string path = folder / "run.mcap";
  std::vector<Command> commands(3);
  for (Command& command : commands) command.hand.scale = 2.0;
  commands[0].second.ball.linear = Vec3(0.1, 0, 0);
  commands[0].second.scale = 2.0;
  commands[1].second.lever_rate = 0.5;
  commands[2].hand.ball.linear = Vec3(nan, 0, 0);
  record(path, commands);
  rewrite(path, [](nlohmann::json& arm) {
    arm.erase("second_scale");
    if (arm.contains("second_lever_rate")) arm["second_direction"] = {1.0, 0.0, 0.0};
    if (arm.erase("not_finite") > 0) arm["linear"] = {nullptr, 0.0, 0.0};
  });
  const std::vector<Command> now = commands_in(path);
  ASSERT_EQ(now.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    expect_same(commands[i].hand, now[i].hand, "first hand");
    expect_same(commands[i].second, now[i].second, "second hand");
  }
}

}  // namespace recording_test
}  // namespace repel::runs
