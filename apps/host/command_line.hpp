/// @file
/// What the command lines of the programs have in common.
#pragma once

#include <CLI/CLI.hpp>
#include <atomic>
#include <cstdio>
#include <fstream>
#include <string>

namespace repel::host {

/// A number between two others. CLI::Range lets NaN pass.
[[nodiscard]] CLI::Validator between(double low, double high);

/// Becomes true when the user or the system asks the program to end, from the first call on.
[[nodiscard]] const std::atomic<bool>& interruption();

/// A file for output, opened before the run so that a long one is not made in vain. Without a path
/// none is wanted. Throws SetupError where it cannot be written.
class Output {
 public:
  explicit Output(const std::string& path);
  [[nodiscard]] bool wanted() const { return !path_.empty(); }
  [[nodiscard]] std::ostream& stream() { return file_; }
  void close();

 private:
  void check() const;

  std::string path_;
  std::ofstream file_;
};

/// A whole main function. Returns the exit status: that of `run`, 0 for --help, 2 for bad usage,
/// `failure` after printing what is thrown.
/// @param describe tells the options, which write to the arguments
template <class Arguments>
[[nodiscard]] int start(int argc, char** argv, const char* name, const char* about, int failure,
                        void (*describe)(CLI::App&, Arguments&), int (*run)(const Arguments&)) {
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
