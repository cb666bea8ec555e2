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

/// A log of a run of the scene `empty` in which these were the commands.
void record(const std::string& path, const std::vector<Command>& commands) {
  const auto prepared = prepare(scene::load(scene_file("empty")), options());
  const World& world = prepared->cell.world();
  DatedShapes shapes;
  const auto log = mcap_log(path, heading_of(prepared->scene, prepared->cell), prepared->scene,
                            options(), world, shapes);
  Snapshot snapshot;
  snapshot.arms.resize(1);
  snapshot.X_WB.assign(world.motion().bodies.size(), Pose::Identity());
  snapshot.is_there.assign(world.motion().bodies.size(), 1);
  for (const Command& command : commands) {
    snapshot.arms.front().command = command;
    log->write(snapshot);
    ++snapshot.arms.front().tick;
  }
  log->close(0);
}

std::vector<Command> commands_in(const std::string& path) {
  const Recording recording = load_recording(path, scene_file);
  std::vector<Command> commands;
  for (const TickRecord& tick : recording.arms.front()) {
    commands.push_back(tick.command);
  }
  return commands;
}

/// All numbers of a hand.
std::vector<double> numbers_of(const HandInput& hand) {
  std::vector<double> all{hand.lever_rate, hand.scale, hand.guide_strength,
                          static_cast<double>(hand.guides), static_cast<double>(hand.compliant)};
  for (const Vec3& v : {hand.ball.linear, hand.ball.angular, hand.direction_W, hand.turning_W}) {
    all.insert(all.end(), {v.x(), v.y(), v.z()});
  }
  return all;
}

/// A NaN is the same as any other.
void expect_same(const HandInput& then, const HandInput& now, const std::string& which) {
  const std::vector<double> a = numbers_of(then);
  const std::vector<double> b = numbers_of(now);
  for (std::size_t i = 0; i < a.size(); ++i) {
    const bool same =
        std::isnan(a[i]) ? std::isnan(b[i])
                         : std::bit_cast<std::uint64_t>(a[i]) == std::bit_cast<std::uint64_t>(b[i]);
    EXPECT_TRUE(same) << which << ", number " << i << ": " << a[i] << " became " << b[i];
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
  for (Vec3* v : {&hand.ball.linear, &hand.ball.angular, &hand.direction_W, &hand.turning_W}) {
    for (int i = 0; i < 3; ++i) draw((*v)[i]);
  }
  for (double* x : {&hand.lever_rate, &hand.scale, &hand.guide_strength}) draw(*x);
  for (std::int32_t* bits : {&hand.guides, &hand.compliant}) {
    if (rng() % 2 == 0) *bits = static_cast<std::int32_t>(rng() % 128);
  }
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
