// SPDX-License-Identifier: BSD-3-Clause
#include "scenes.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <vector>

#include <repel/base/setup_error.hpp>
#include <repel/host/command_line.hpp>

namespace repel::teleop {

namespace fs = std::filesystem;

std::map<std::string, std::string> shipped_scenes() {
  std::map<std::string, std::string> scenes;
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error).parent_path();
  for (const char* folder : {"../../../scenes", "../share/repel/scenes"}) {
    for (const auto& entry : fs::directory_iterator(program / folder, error)) {
      const fs::path path = fs::weakly_canonical(entry.path());
      if (path.extension() == ".yaml") scenes.emplace(path.stem().string(), path.string());
    }
  }
  return scenes;
}

std::string scene_list() {
  std::string text;
  for (const auto& scene : shipped_scenes()) text += "\n  " + scene.first;
  return text;
}

std::string find_scene(const std::string& name) {
  if (fs::exists(name)) return name;
  const auto scenes = shipped_scenes();
  if (scenes.contains(name)) return scenes.at(name);
  std::vector<std::string> names;
  for (const auto& scene : scenes) names.push_back(scene.first);
  const std::string meant = host::closest(name, names);
  throw SetupError("no such scene" + (meant.empty() ? "" : " (did you mean " + meant + "?)") +
                       "; allowed: a file or one of" + scene_list(),
                   name.empty() ? "''" : name);
}

std::string about_scene(const std::string& file) {
  std::ifstream lines(file);
  std::string text;
  for (std::string line; std::getline(lines, line) && line.starts_with("# ");) {
    if (!line.starts_with("# SPDX-")) text += line.substr(2) + " ";
  }
  return text.substr(0, std::min(text.find(". "), text.find(": ")));
}

}  // namespace repel::teleop
