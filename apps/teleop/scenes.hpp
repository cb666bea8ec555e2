// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The scenes that come with the program.
#pragma once

#include <map>
#include <string>

namespace repel::teleop {

/// Paths of their files by name, from the source tree that this was built in, or the installation.
[[nodiscard]] std::map<std::string, std::string> shipped_scenes();

/// Their names, each behind a line break.
[[nodiscard]] std::string scene_list();

/// The path of a scene file, or of the shipped scene of that name.
/// @throws SetupError if there is none, naming those there are
[[nodiscard]] std::string find_scene(const std::string& name);

/// The comment at the head of a scene file, up to a full stop or colon; empty: there is none.
[[nodiscard]] std::string about_scene(const std::string& file);

}  // namespace repel::teleop
