// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <utility>

#include "options.hpp"
#include "scenes.hpp"

namespace repel::teleop {
namespace {

/// Options of the past, with what they took, and the option or command line that they are by now.
constexpr std::pair<const char*, const char*> old_spellings[] = {
    {"--hold", "--walls"},
    {"--apart", "--programs two"},
    {"--together", "--programs one"},
    {"--replay FILE", "teleop replay FILE"},
    {"--site", "teleop site SCENE"},
    {"--station", "teleop station SCENE"}};

std::string in_present_words(const std::string& word) {
  const std::string option = word.substr(0, word.find('='));
  for (const auto& [old, now] : old_spellings) {
    const std::string usage = old;
    std::string present = now;
    if (option != usage.substr(0, usage.find(' '))) continue;
    if (present[0] != '-') throw CLI::ValidationError(usage + " is by now: " + present);
    std::fprintf(stderr, "teleop: %s is %s by now\n", old, now);
    std::replace(present.begin(), present.end(), ' ', '=');
    return present + word.substr(option.size());
  }
  return word;
}

}  // namespace

void reword(const CLI::App& app, std::vector<std::string>& words) {
  std::transform(words.begin(), words.end(), words.begin(), in_present_words);
  std::vector<std::string> known, names;
  for (const CLI::App* command : app.get_subcommands({})) known.push_back(command->get_name());
  const auto is_command = [&](const std::string& word) {
    return std::find(known.begin(), known.end(), word) != known.end();
  };
  const std::string first = words.empty() ? "" : words.front();
  if (is_command(first) || first == "--help" || first == "-h" || first == "--version") return;
  for (const auto& scene : shipped_scenes()) names.push_back(scene.first);
  names.insert(names.end(), known.begin(), known.end());
  const std::string meant = host::closest(first, names);
  if (is_command(meant) && !first.starts_with('-') && !std::filesystem::exists(first)) {
    throw CLI::ValidationError("unknown command " + first + "; did you mean " + meant + "?");
  }
  words.insert(words.begin(), "run");
}

}  // namespace repel::teleop
