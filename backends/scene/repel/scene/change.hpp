// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Other values than those of a scene file.
#pragma once

#include <string>

namespace repel::scene {

/// A value in place of one of a scene file.
struct Change {
  /// The names of maps and keys on the way to it, with dots between them, as
  /// `laws.glass.surface_force`. An entry of a list is called by its `name` or `module`, or by its
  /// number, from 0; so is one number of several: `robot.start.1`. What is not there is added.
  std::string path;
  std::string
      value;  ///< as the file would have it: `40 N`, `[wrist_3]`; one number is without unit
};

}  // namespace repel::scene
