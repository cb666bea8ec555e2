// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A run with its live view and log, repeated when a page requests a restart.
#pragma once

#include <atomic>
#include <functional>

#include <repel/runs/engine/run.hpp>
#include <repel/runs/options/run_options.hpp>
#include <repel/runs/options/session_options.hpp>
#include <repel/runs/records/recording.hpp>
#include <repel/runs/report/results.hpp>
#include <repel/scene/scene.hpp>

namespace repel::runs {

/// Runs the scene, or replays the recording, until it is over or `stop`; with a view, repeats it as
/// often as a page requests. Returns the result of the last run. Prints on stderr the URL of the
/// view, and any failure of the log as soon as it occurs. A complete log is moved to its target:
/// see PartFile.
/// @param recording null: none
/// @param stop fades the forces and ends the run
/// @param at_once ends the run without fading
/// @throws SetupError if the scene cannot be built, or a file or an address is not available
[[nodiscard]] RunResult run_session(const scene::Scene& scene, const RunOptions& options,
                                    const SessionOptions& session, const Recording* recording,
                                    const std::atomic<bool>& stop, const std::atomic<bool>& at_once,
                                    const std::function<void(const Progress&)>& show);

}  // namespace repel::runs
