// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A small scene as lines of text, to be modified one line at a time.
#pragma once

#include <string>

#include <repel/scene/scene.hpp>

namespace repel::scene::testing {

/// Line 3 is the start, 5 the tool part, 6 the obstacles, 7 the first obstacle.
inline const std::string base_scene =
    "robot:\n"
    "  urdf: ../robots/puma560.urdf\n"
    "  start: 0 45 180 0 45 0 deg\n"
    "tool:\n"
    "  - {name: rod, shape: sphere, radius: 20 mm}\n"
    "obstacles:\n"
    "  - {name: wall, shape: box, size: 1 2 3 m}\n";

/// `base_scene` with the first occurrence of `old_text` replaced by `new_text`.
inline std::string changed(const std::string& old_text, const std::string& new_text) {
  std::string text = base_scene;
  return text.replace(text.find(old_text), old_text.size(), new_text);
}

/// Parses text as if it were a file in scenes/.
inline Scene parsed(const std::string& text) {
  return parse(text, "scenes/test.yaml");
}

/// The options of the first module of the network.
template <class Options>
Options options(const Scene& scene) {
  return std::any_cast<Options>(scene.network.modules.front().options);
}

}  // namespace repel::scene::testing
