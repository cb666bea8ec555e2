/// @file
/// A run with all that is around it: a live view, a log, another run when the page asks for one.
#pragma once

#include <atomic>
#include <functional>
#include <string>

#include "run.hpp"

namespace repel::teleop {

struct SessionOptions {
  bool view = false;
  std::string listen = "127.0.0.1:8448";  ///< ADDRESS:PORT of the live view
  std::string page;                       ///< folder of its files
  std::string device;                     ///< that drives; empty: none
};

/// What is wrong with ADDRESS:PORT; empty: nothing.
[[nodiscard]] std::string listen_complaint(const std::string& listen);

/// Runs the scene, or what was recorded of it, until it is over or `stop`; with a view, as often as
/// the page asks for it. The last run is reported. Says on stderr where the view is, and at once
/// when the log cannot be written on. The log stands in its place when it is whole: see PartFile.
/// @param recording null: none
/// @param stop fades the forces and ends the run, `at_once` without that
/// @throws SetupError for a scene that cannot be built, a file or an address that cannot be had
[[nodiscard]] RunResult run_session(const scene::Scene& scene, const RunOptions& options,
                                    const SessionOptions& session, const Recording* recording,
                                    const std::atomic<bool>& stop, const std::atomic<bool>& at_once,
                                    const std::function<void(const Progress&)>& show);

}  // namespace repel::teleop
