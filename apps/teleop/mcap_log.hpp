/// @file
/// Runs as MCAP files: written tick by tick, read for replay.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "log.hpp"
#include "recording.hpp"

namespace repel::teleop {

/// A file for `load_recording`, Foxglove and the `mcap` package; docs/recording.md has its
/// channels. It contains the scene and the robots too.
/// @throws SetupError if the file cannot be written
[[nodiscard]] std::unique_ptr<TickLog> mcap_log(const std::string& path, const Heading& heading,
                                                const scene::Scene& scene,
                                                const RunOptions& options);

/// Reads such a file, up to the first missing tick: what follows cannot be replayed.
/// @param find returns the path of the scene of that name, in whose folder its robots are
/// @throws SetupError if the file is no such recording, or a robot file has changed since
[[nodiscard]] Recording load_recording(const std::string& path,
                                       const std::function<std::string(const std::string&)>& find);

}  // namespace repel::teleop
