// SPDX-License-Identifier: BSD-3-Clause
// Arbitrary text as the contents of a recording, or arbitrary bytes as its file: loaded, or refused
// by a SetupError that names a file. A text is divided by lines of %%: metadata of the run, the
// scene, then messages that begin with the letter of their channel.
#include <repel/runs/records/mcap_names.hpp>
#include <repel/runs/records/recording.hpp>

#include <cmath>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <end_to_end/folder.hpp>
#include <fuzz/bytes.hpp>
#include <repel/record/mcap_writer.hpp>

namespace repel::runs {
namespace {

using fuzz::require;

std::vector<std::string> split(const std::string& text, const std::string& by) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  for (std::size_t end = 0; end != std::string::npos; begin = end + by.size()) {
    end = text.find(by, begin);
    parts.push_back(text.substr(begin, end == std::string::npos ? end : end - begin));
  }
  return parts;
}

/// Lines of key=value.
std::map<std::string, std::string> words_of(const std::string& text) {
  std::map<std::string, std::string> words;
  for (const std::string& line : split(text, "\n")) {
    const auto at = line.find('=');
    if (at != std::string::npos) words[line.substr(0, at)] = line.substr(at + 1);
  }
  return words;
}

void write_recording(const std::string& path, const std::string& text) {
  static const std::string robot = test::text_of("robots/puma560.urdf");
  const std::vector<std::string> parts = split(text, "\n%%\n");
  record::McapWriter writer(path, {});
  writer.add_metadata(mcap::run_metadata, words_of(parts[0]));
  if (parts.size() > 1) writer.attach(mcap::scene_attachment, "application/yaml", parts[1], 0);
  for (int i = 0; i < 3; ++i) {
    std::string name = "robot ";
    name += std::to_string(i) + ".urdf";
    writer.attach(name, "application/xml", robot, 0);
  }
  std::map<char, std::uint16_t> channels;
  for (const mcap::Channel& channel : {mcap::inputs, mcap::forces, mcap::timing}) {
    const auto schema = writer.add_schema(channel.schema, "jsonschema", "{}");
    channels[channel.topic[1]] = writer.add_channel(channel.topic, schema, "json");
  }
  for (std::size_t i = 2; i < parts.size(); ++i) {
    const auto channel = channels.find(parts[i].empty() ? ' ' : parts[i][0]);
    if (channel == channels.end()) continue;
    writer.write(channel->second, static_cast<std::uint32_t>(i), i,
                 std::string_view(parts[i]).substr(1));
  }
  writer.close();
}

void check_one(const std::string& text) {
  static const test::Folder folder;
  const std::string path = folder / "fuzz.mcap";
  if (text.substr(0, 5) == "\x89MCAP") {
    (void)folder.with("fuzz.mcap", text);
  } else {
    write_recording(path, text);
  }
  try {
    const Recording recording =
        load_recording(path, [](const std::string&) { return "scenes/empty.yaml"; });
    require(recording.ticks() > 0, "it has a tick");
    require(recording.options.seconds > 0.0 && std::isfinite(recording.options.seconds), "it ends");
    for (const auto& arm : recording.arms) {
      require(arm.size() == recording.ticks(), "each arm has all ticks");
    }
  } catch (const SetupError& error) {
    require(!error.file().empty(), "an error names a file");
  }
}

}  // namespace
}  // namespace repel::runs

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  repel::runs::check_one(std::string(data, data + size));
  return 0;
}
