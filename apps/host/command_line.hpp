/// @file
/// What the command lines of the programs have in common.
#pragma once

#include <CLI/CLI.hpp>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <string>

#include "part_file.hpp"

namespace repel::host {

/// A number between two others. CLI::Range lets NaN pass.
[[nodiscard]] CLI::Validator between(double low, double high);

/// Becomes true when the user or the system asks the program to end (SIGINT, SIGTERM, SIGHUP), from
/// the first call on. A SIGHUP that is ignored, as by nohup, stays so.
[[nodiscard]] const std::atomic<bool>& interruption();

/// Becomes true when that is asked for again by SIGINT or SIGTERM, 0.1 s later or more: what comes
/// at once is the same wish, sent to the program and to its group. After that a signal kills.
[[nodiscard]] const std::atomic<bool>& insistence();

/// A file for output, opened before the run so that a long one is not made in vain, and in its
/// place when it is closed: see PartFile. Without a path none is wanted.
class Output {
 public:
  /// @throws SetupError where it cannot be written
  explicit Output(const std::string& path);
  [[nodiscard]] bool wanted() const { return !path_.empty(); }
  /// To be written to without a pause: what the system says of a failure is taken at close().
  [[nodiscard]] std::ostream& stream();
  /// @throws SetupError where it could not be written whole
  void close();

 private:
  void check() const;

  std::string path_;
  PartFile part_;
  std::ofstream file_;
};

/// Whether all that was printed to stdout has arrived. A reader that left a pipe had enough: true.
[[nodiscard]] bool has_printed();

/// A whole main function, which a reader that leaves its pipe does not end. Returns the exit
/// status: that of `run`, 0 for --help, 2 for bad usage, `failure` after printing what is thrown.
/// @param describe tells the options, which write to the arguments
template <class Arguments>
[[nodiscard]] int start(int argc, char** argv, const char* name, const char* about, int failure,
                        void (*describe)(CLI::App&, Arguments&), int (*run)(const Arguments&)) {
  (void)std::signal(SIGPIPE, SIG_IGN);  // a reader that leaves does not end what goes on
  try {
    Arguments arguments;
    CLI::App app(about, name);
    describe(app, arguments);
    try {
      app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
      return app.exit(error) == 0 ? 0 : 2;
    }
    return run(arguments);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", name, error.what());
    return failure;
  }
}

}  // namespace repel::host
