// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Shared command line handling of the programs.
#pragma once

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <repel/host/part_file.hpp>

namespace repel::host {

/// Accepts a number from `low` to `high`. Unlike CLI::Range, it rejects NaN.
[[nodiscard]] CLI::Validator between(double low, double high);

/// Installs handlers for SIGINT, SIGTERM and SIGHUP; the result becomes true at the first such
/// signal. A SIGHUP that is ignored, as under nohup, stays ignored.
[[nodiscard]] const std::atomic<bool>& interruption();

/// Becomes true at a second SIGINT or SIGTERM at least 0.1 s after the first signal; an earlier one
/// is the same request, sent to the program and to its process group. After that, the next one
/// kills the program.
[[nodiscard]] const std::atomic<bool>& insistence();

/// An output file. Opened before the run, so a long run does not fail at its end, and moved into
/// its place by close(); see PartFile. An empty path means no output.
class Output {
 public:
  /// @throws SetupError if the file cannot be written
  explicit Output(const std::string& path);
  [[nodiscard]] bool wanted() const { return !path_.empty(); }
  /// The stream, to be written to and closed without other system calls in between: close() takes
  /// the reason of a failure from errno.
  [[nodiscard]] std::ostream& stream();
  /// @throws SetupError if not everything could be written
  void close();

 private:
  void check() const;

  std::string path_;
  PartFile part_;
  std::ofstream file_;
};

/// Whether everything printed to stdout was written. True as well when stdout is a pipe whose
/// reader has exited.
[[nodiscard]] bool has_printed();

/// The program's name, the version of the library, and the commit it was built from.
[[nodiscard]] std::string version_of(const char* name);

/// The likely intended one of `words`: the nearest to `word` by letters added, left out, replaced
/// or swapped with the next; the first of several. Empty beyond a third of its letters, if more
/// than one.
[[nodiscard]] std::string closest(const std::string& word, std::span<const std::string> words);

/// Gives a program --version, a help of 100 columns, and complaints with its name and the likely
/// option or its command. To be called before its options and commands are added.
void set_up(CLI::App& app);

/// Refuses values without a character, as `--log "$UNSET"` gives: the output would be lost without
/// a word. To be called after the command line is parsed. @throws CLI::ValidationError
void refuse_empty(const CLI::App& app);

/// The body of main(): parses the command line and calls `run`. Ignores SIGPIPE, so the exit of a
/// reader does not end the program. Returns the exit status: that of `run`, 0 for --help and
/// --version, 2 for bad usage, `failure` after printing the message of an exception.
/// @param describe declares the options, which write to the arguments
/// @param reword changes the words of the command line before they are parsed; null: nothing does
template <class Arguments>
[[nodiscard]] int start(int argc, char** argv, const char* name, const char* about, int failure,
                        void (*describe)(CLI::App&, Arguments&), int (*run)(const Arguments&),
                        void (*reword)(const CLI::App&, std::vector<std::string>&) = nullptr) {
  (void)std::signal(SIGPIPE, SIG_IGN);  // a reader that exits must not end the run
  try {
    Arguments arguments;
    CLI::App app(about, name);
    set_up(app);
    describe(app, arguments);
    try {
      std::vector<std::string> words(argv + std::min(argc, 1), argv + argc);
      if (reword != nullptr) reword(app, words);
      std::reverse(words.begin(), words.end());  // as CLI11 wants them
      app.parse(std::move(words));
      refuse_empty(app);
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
