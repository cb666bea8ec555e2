// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Runs as MCAP files, written tick by tick; recording.hpp reads them.
#pragma once

#include <memory>
#include <string>

#include <repel/runs/options/run_options.hpp>
#include <repel/runs/records/dated.hpp>
#include <repel/runs/records/heading.hpp>
#include <repel/runs/records/log.hpp>
#include <repel/scene/scene.hpp>

namespace repel::runs {

/// A file for `load_recording`, Foxglove and the `mcap` package; docs/recording.md has its
/// channels. It contains the scene and the robots too. Compressed if that was built in.
/// @param cell as it is at the start
/// @param shown of the parts of its world, for their colours
/// @param beside what the run tells while it lasts; must outlive the log
/// @throws SetupError if the file cannot be written
[[nodiscard]] std::unique_ptr<TickLog> mcap_log(const std::string& path, const Heading& heading,
                                                const scene::Scene& scene,
                                                const RunOptions& options, const Cell& cell,
                                                const std::vector<scene::Shown>& shown,
                                                BesideTicks& beside);

}  // namespace repel::runs
