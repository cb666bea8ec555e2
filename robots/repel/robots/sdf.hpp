// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Reads models and worlds from SDF files, as parts that stand still.
#pragma once

#include <string>
#include <vector>

#include <repel/robots/built_alike.hpp>
#include <repel/robots/robot.hpp>

namespace repel {

/// The collision elements of all models in the SDF file at `path`, of its world or without one, as
/// parts of one body: their poses are in the frame of that world, with every joint at zero. In
/// RobotPart::in_link, the names of models and link are joined by `::`.
/// @param options of which only those about meshes count; `package_paths` are also where
///   model://NAME is searched
/// @throws SetupError naming file, line, value and allowed values, if the file cannot be read, has
///   several worlds, or a collision other than box, sphere, cylinder, capsule or mesh; always if
///   built without libsdformat
[[nodiscard]] std::vector<RobotPart> load_sdf_parts(const std::string& path,
                                                    const UrdfOptions& options = {});

/// Whether this build can read SDF files.
[[nodiscard]] bool reads_sdf() noexcept;

}  // namespace repel
