// SPDX-License-Identifier: BSD-3-Clause
// Recordings have joints, events and depth images where Foxglove looks for them, and the layout
// that comes with them finds what it shows.
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <repel/base/status.hpp>
#include <repel/record/mcap_reader.hpp>
#include <repel/runs/records/depth_picture.hpp>
#include <repel/runs/records/mcap_events.hpp>
#include <repel/runs/setup/prepared_run.hpp>
#include <repel/scene/scene.hpp>

#include "end_to_end/teleop.hpp"

namespace repel::test {
namespace foxglove_test {

using nlohmann::json;

struct Told {
  std::uint32_t tick = 0;
  std::uint64_t time_ns = 0;
  json value{};
};

/// The messages of every topic; those with a schema of Foxglove are of the schema `as_expected`.
std::map<std::string, std::vector<Told>> messages_of(const std::string& file) {
  static const std::map<std::string, std::string> expected{
      {"/joints", "foxglove.JointStates"},
      {"/log", "foxglove.Log"},
      {"/cameras/camera", "foxglove.RawImage"}};
  record::McapReader reader(file);
  std::map<std::string, std::vector<Told>> all;
  record::McapMessage message;
  while (reader.next(message)) {
    const record::McapChannel& channel = reader.channels().at(message.channel);
    const auto found = expected.find(channel.topic);
    if (found != expected.end()) {
      EXPECT_EQ(reader.schemas().at(channel.schema).name, found->second);
    }
    all[channel.topic].push_back(
        {message.sequence, message.log_time_ns, json::parse(message.data)});
  }
  return all;
}

std::map<std::string, std::vector<Told>> recorded(const std::string& arguments) {
  const Folder folder;
  const Ending ending = teleop(arguments + " --log " + quoted(folder / "run.mcap"));
  EXPECT_EQ(ending.status, 0) << ending;
  return messages_of(folder / "run.mcap");
}

std::uint64_t ns_of(const json& time) {
  return 1000000000U * time.at("sec").get<std::uint64_t>() + time.at("nsec").get<std::uint64_t>();
}

TEST(Foxglove, JointsAreThoseOfAllArmsBitForBit) {
  auto run = recorded("two_arms --fast --seconds 1");
  const auto prepared =
      runs::prepare(scene::load(REPEL_SOURCE "/scenes/two_arms.yaml"), runs::RunOptions{});
  std::vector<std::string> names;
  for (const ArmDescription& arm : prepared->cell.description().arms) {
    for (const ArmLink& link : arm.model.links) {
      names.push_back((arm.name.empty() ? "" : arm.name + "/") + link.joint_name);
    }
  }
  EXPECT_EQ(run["/joints"].size(), 100U);
  double effort = 0.0;
  for (const Told& message : run["/joints"]) {
    EXPECT_EQ(ns_of(message.value.at("timestamp")), message.time_ns);
    const json& joints = message.value.at("joints");
    ASSERT_EQ(joints.size(), names.size());
    std::size_t at = 0;
    for (std::size_t arm = 0; arm < 2; ++arm) {
      const json& inputs = run["/inputs"].at(message.tick).value.at("arms").at(arm);
      const json& forces = run["/forces"].at(message.tick).value.at("arms").at(arm);
      for (std::size_t i = 0; i < inputs.at("q").size(); ++i, ++at) {
        EXPECT_EQ(joints.at(at).at("name"), names[at]);
        EXPECT_EQ(joints.at(at).at("position"), inputs.at("q").at(i));
        EXPECT_EQ(joints.at(at).at("velocity"), inputs.at("v").at(i));
        EXPECT_EQ(joints.at(at).at("effort"), forces.at("torques").at(i));
        effort = std::max(effort, std::abs(joints.at(at).at("effort").get<double>()));
      }
    }
  }
  EXPECT_GT(effort, 1.0);
  EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size());
}

TEST(Foxglove, EveryBitOfTheStatusHasWords) {
  for (unsigned place = 0; place < 32; ++place) {
    const Status bit = 1U << place;
    EXPECT_EQ(runs::mcap::words_of(bit).empty(), to_text(bit) == "ok") << to_text(bit);
  }
}

/// The only message of the log with these words; -1: there is none, or there are several.
int index_of(const std::vector<Told>& log, const std::string& words) {
  int found = -1;
  for (std::size_t i = 0; i < log.size(); ++i) {
    if (log[i].value.at("message").get<std::string>().find(words) == std::string::npos) continue;
    if (found >= 0) return -1;
    found = static_cast<int>(i);
  }
  return found;
}

// A device that stops sending for half a second.
TEST(Foxglove, TheLogSaysWhatBeginsAndEndsAndHowBadItIs) {
  const Folder folder;
  const std::string script =
      "script:\n"
      "  - {name: first, device: spaceball, duration: 500 ms, linear: 0 0 10 mm/s}\n"
      "  - {name: lost, device: spaceball, duration: 500 ms, silent: yes}\n"
      "  - {name: back, device: spaceball, duration: 500 ms, linear: 0 0 10 mm/s}\n";
  const std::string scene = folder.with("scene.yaml", robot_text() + table_text() + script);
  auto run = recorded(quoted(scene) + " --fast --seconds 2");
  const std::vector<Told>& log = run["/log"];
  const auto level_of = [&](const std::string& words) {
    const int found = index_of(log, words);
    return found < 0 ? -1 : log[static_cast<std::size_t>(found)].value.at("level").get<int>();
  };
  const auto tick_of = [&](const std::string& words) {
    return static_cast<int>(log[static_cast<std::size_t>(index_of(log, words))].tick);
  };
  constexpr int info = 2;
  constexpr int warning = 3;
  ASSERT_EQ(level_of("the scene scene at 400 Hz"), info);
  ASSERT_EQ(level_of("phase: first"), info);
  ASSERT_EQ(level_of("phase: lost"), info);
  ASSERT_EQ(level_of("silent_device: the device is silent"), warning);
  ASSERT_EQ(level_of("silent_device is over, after 0.4"), info);
  ASSERT_EQ(level_of("holding: "), warning);
  ASSERT_EQ(level_of("running: "), info);
  ASSERT_EQ(level_of("no script plays any more"), info);
  EXPECT_NEAR(tick_of("phase: lost"), 200, 2);
  EXPECT_NEAR(tick_of("silent_device: "), 208, 4) << "after 20 ms";
  EXPECT_NEAR(tick_of("no script plays"), 600, 3);
  // The log has every change of the status and of what was done about it, and no more.
  int silences = 0;
  bool was_silent = false;
  for (const Told& inputs : run["/inputs"]) {
    const Status bits = inputs.value.at("arms").at(0).at("status");
    const bool is_silent = (bits & status::silent_device) != 0U;
    silences += is_silent && !was_silent ? 1 : 0;
    was_silent = is_silent;
  }
  EXPECT_EQ(silences, 1);
  for (const Told& message : log) {
    EXPECT_EQ(ns_of(message.value.at("timestamp")), message.time_ns);
    for (const char* key : {"level", "message", "name", "file", "line"}) {
      EXPECT_TRUE(message.value.contains(key)) << key;
    }
  }
}

/// What base64 stands for.
std::vector<unsigned> bytes_of(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<unsigned> bytes;
  for (std::size_t i = 0; i + 3 < text.size(); i += 4) {
    unsigned group = 0;
    int padding = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      const std::size_t digit = digits.find(text[i + k]);
      padding += digit == std::string::npos ? 1 : 0;
      group = group << 6U | (digit == std::string::npos ? 0U : static_cast<unsigned>(digit));
    }
    for (int k = 0; k < 3 - padding; ++k) bytes.push_back(group >> (16 - 8 * k) & 255U);
  }
  return bytes;
}

TEST(Foxglove, ImagesAreTheDepthsOfTheCameraAtItsRate) {
  auto run = recorded("seen --fast --seconds 2");
  const std::vector<Told>& images = run["/cameras/camera"];
  EXPECT_NEAR(static_cast<double>(images.size()), 60.0, 1.0) << "30 Hz";
  const scene::CameraChoice camera = scene::load(REPEL_SOURCE "/scenes/seen.yaml").cameras.front();
  std::set<std::string> frames;
  for (const json& each : run["/poses"].front().value.at("transforms")) {
    frames.insert(each.at("child_frame_id").get<std::string>());
  }
  for (const Told& message : images) {
    const json& image = message.value;
    EXPECT_EQ(ns_of(image.at("timestamp")), message.time_ns);
    EXPECT_TRUE(frames.contains(image.at("frame_id").get<std::string>()));
    EXPECT_EQ(image.at("encoding"), "16UC1");
    EXPECT_LE(image.at("width").get<int>() * image.at("height").get<int>(),
              runs::most_picture_pixels);
    EXPECT_EQ(image.at("step").get<int>(), 2 * image.at("width").get<int>());
    const std::vector<unsigned> bytes = bytes_of(image.at("data"));
    ASSERT_EQ(bytes.size(),
              image.at("step").get<std::size_t>() * image.at("height").get<std::size_t>());
    std::size_t measured = 0;
    for (std::size_t i = 0; i < bytes.size(); i += 2) {
      const unsigned depth = bytes[i] + 256 * bytes[i + 1];
      if (depth == 0) continue;
      ++measured;
      EXPECT_GE(depth, 1e3 * camera.nearest - 1.0);
      EXPECT_LE(depth, 1e3 * camera.farthest + 1.0);
    }
    EXPECT_GT(measured, bytes.size() / 8) << "a quarter of the pixels";
  }
}

TEST(Foxglove, ALargeImageIsThinnedEvenly) {
  std::vector<float> depth(1920 * 1080);
  for (std::size_t i = 0; i < depth.size(); ++i) {
    depth[i] = static_cast<float>(i % 1920) * 1e-3F;
  }
  depth[0] = std::nanf("");
  depth[6] = -1.0F;
  depth[12] = 100.0F;
  const runs::DepthPicture picture = runs::depth_picture(1, 0.5, 1920, 1080, depth);
  EXPECT_EQ(picture.width, 320);
  EXPECT_EQ(picture.height, 180);
  ASSERT_EQ(picture.depth.size(), 320U * 180U);
  EXPECT_EQ(picture.depth[0], 0);
  EXPECT_EQ(picture.depth[1], 0);
  EXPECT_EQ(picture.depth[2], 65535);
  EXPECT_EQ(picture.depth[3], 18);
  EXPECT_EQ(picture.depth.back(), 1914);
  EXPECT_EQ(runs::depth_picture(0, 0.0, 320, 240, std::vector<float>(320 * 240)).width, 320);
}

/// Every text of the layout that begins as a topic does, keys included.
void collect_paths(const json& value, std::set<std::string>& paths) {
  if (value.is_string() && value.get<std::string>().starts_with("/")) paths.insert(value);
  if (!value.is_structured()) return;
  for (const auto& [key, item] : value.items()) {
    if (key.starts_with("/")) paths.insert(key);
    collect_paths(item, paths);
  }
}

/// Every panel that the layout places.
void collect_panels(const json& place, std::multiset<std::string>& panels) {
  if (place.is_string()) {
    panels.insert(place);
    return;
  }
  for (const char* half : {"first", "second"}) collect_panels(place.at(half), panels);
}

/// Whether a message has a number or a text at `path`: ".name" or "[index]", one behind the other.
bool has(const json& message, const std::string& path) {
  const json* at = &message;
  for (std::size_t begin = 0; begin < path.size();) {
    const std::size_t end = std::min(path.find_first_of(".[", begin + 1), path.size());
    if (path[begin] == '.') {
      const std::string name = path.substr(begin + 1, end - begin - 1);
      if (!at->is_object() || !at->contains(name)) return false;
      at = &at->at(name);
    } else {
      const auto index = static_cast<std::size_t>(std::stoi(path.substr(begin + 1)));
      if (!at->is_array() || index >= at->size()) return false;
      at = &at->at(index);
    }
    begin = end;
  }
  return path.empty() || at->is_number() || at->is_string();
}

TEST(Foxglove, TheLayoutFindsAllThatItShows) {
  const json layout = json::parse(text_of(REPEL_SOURCE "/docs/foxglove_layout.json"));
  auto run = recorded("seen --fast --seconds 2");
  std::set<std::string> paths;
  collect_paths(layout.at("configById"), paths);
  EXPECT_GT(paths.size(), 15U);
  for (const std::string& path : paths) {
    const std::size_t end = std::min(path.find('.'), path.size());
    const std::string topic = path.substr(0, end);
    ASSERT_TRUE(run.contains(topic)) << path;
    const bool is_there = std::any_of(run[topic].begin(), run[topic].end(), [&](const Told& each) {
      return has(each.value, path.substr(end));
    });
    EXPECT_TRUE(is_there) << path;
  }
  for (const auto& [topic, messages] : run) {  // and of what has a panel, all is shown
    if (topic == "/poses" || topic == "/energy") continue;
    EXPECT_TRUE(std::any_of(paths.begin(), paths.end(),
                            [&, &name = topic](const std::string& path) {
                              return path == name || path.starts_with(name + ".");
                            }))
        << topic;
  }
  std::multiset<std::string> placed;
  collect_panels(layout.at("layout"), placed);
  for (const auto& [panel, config] : layout.at("configById").items()) {
    if (!config.contains("tabs")) continue;
    for (const json& tab : config.at("tabs")) collect_panels(tab.at("layout"), placed);
  }
  for (const auto& [panel, config] : layout.at("configById").items()) {
    EXPECT_EQ(placed.erase(panel), 1U) << panel;
  }
  EXPECT_TRUE(placed.empty());
}

}  // namespace foxglove_test
}  // namespace repel::test
