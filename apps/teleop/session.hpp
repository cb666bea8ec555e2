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
  std::string secret_file;                ///< whose first line a page must present; empty: none
  std::string secret_env;                 ///< name of the variable that has it instead
  std::string secret;                     ///< itself, once settle_secret has read it
  bool view_only = false;                 ///< pages look on
  bool page_drives = false;               ///< pages may take the controls from the device
};

/// What is wrong with ADDRESS:PORT; empty: nothing.
[[nodiscard]] std::string listen_complaint(const std::string& listen);

/// Reads the secret from where the options say. What is wrong with it, or with listening without
/// one where other machines reach the view; empty: nothing.
[[nodiscard]] std::string settle_secret(SessionOptions& session);

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
