/// @file
/// A run with its live view and log, repeated when a page requests a restart.
#pragma once

#include <atomic>
#include <functional>
#include <string>

#include "run.hpp"

namespace repel::teleop {

struct SessionOptions {
  bool view = false;
  std::string listen = "127.0.0.1:8448";  ///< ADDRESS:PORT of the live view
  std::string page;                       ///< folder of the files of the page
  std::string device;                     ///< input device; empty: none
  std::string secret_file;   ///< its first line is the secret that a page must present; empty: none
  std::string secret_env;    ///< environment variable with the secret, instead
  std::string secret;        ///< the secret, once settle_secret has read it
  bool view_only = false;    ///< pages may only watch
  bool page_drives = false;  ///< pages may override the device
};

/// What is wrong with ADDRESS:PORT; empty: nothing.
[[nodiscard]] std::string listen_complaint(const std::string& listen);

/// Reads the secret from the file or variable of the options. Returns what is wrong with it, or
/// that listening on an address reachable from other machines requires one; empty: nothing.
[[nodiscard]] std::string settle_secret(SessionOptions& session);

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

}  // namespace repel::teleop
