/// @file
/// Runs as MCAP files: written tick by tick, read to be gone through again.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "log.hpp"
#include "recording.hpp"

namespace repel::teleop {

/// A file that `load_recording`, Foxglove and the `mcap` package read; docs/recording.md has its
/// channels. It holds the scene and the robots as well.
/// @throws SetupError when the file cannot be written
[[nodiscard]] std::unique_ptr<TickLog> mcap_log(const std::string& path, const Heading& heading,
                                                const scene::Scene& scene,
                                                const RunOptions& options);

/// Reads such a file. What comes after a tick that is missing cannot be gone through again and is
/// left out.
/// @param find gives the path of the scene of that name, beside which its robots are
/// @throws SetupError for a file that is no such recording, and when a robot is not as it was
[[nodiscard]] Recording load_recording(const std::string& path,
                                       const std::function<std::string(const std::string&)>& find);

}  // namespace repel::teleop
