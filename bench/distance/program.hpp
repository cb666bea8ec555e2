// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Common code of the programs that compare libraries.
#pragma once

#include <charconv>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include <benchmark/benchmark.h>

#include <repel/base/setup_error.hpp>

namespace repel::bench {

/// The arguments of a command line, removed one by one as they are read.
class Arguments {
 public:
  /// The first argument, the program name, is skipped.
  explicit Arguments(const std::vector<std::string>& words)
      : words_(words.begin() + 1, words.end()) {}

  /// Removes `flag`; true if it was given.
  [[nodiscard]] bool has(const std::string& flag);
  /// The value after `flag`, else `otherwise`. Throws std::invalid_argument if the value is
  /// missing.
  [[nodiscard]] std::string value(const std::string& flag, const std::string& otherwise);
  /// The number after `flag`, else `otherwise`. Throws std::invalid_argument for what is no number
  /// from `low` to `high`.
  template <class Number>
  [[nodiscard]] Number number(const std::string& flag, Number otherwise, Number low, Number high) {
    const std::optional<std::string> text = taken(flag);
    if (!text) return otherwise;
    Number number{};
    const char* const end = text->data() + text->size();
    const auto [rest, error] = std::from_chars(text->data(), end, number);
    if (error == std::errc() && rest == end && number >= low && number <= high) return number;
    throw std::invalid_argument(flag + " is '" + *text +
                                "'; allowed: " + to_text(static_cast<double>(low)) + " to " +
                                to_text(static_cast<double>(high)));
  }
  /// Throws std::invalid_argument if an argument is left.
  void end() const;

 private:
  [[nodiscard]] std::optional<std::string> taken(const std::string& flag);

  std::vector<std::string> words_;
};

/// Options of the programs that time single queries.
struct QueryOptions {
  std::vector<std::string> rivals;  ///< only these libraries; empty: all
  bool quick = false;               ///< fewer pairs, less time
  bool list = false;                ///< say what there is to measure
  double seconds = 0.0;             ///< [s] of a measurement
};

/// What is left of `arguments`; `seconds` where none are given. Throws std::invalid_argument for
/// what is unknown.
[[nodiscard]] QueryOptions query_options(Arguments arguments, double seconds);

/// The parts of a list "a,b,c".
[[nodiscard]] std::vector<std::string> split(const std::string& names);

/// True if `name` is in `chosen`, or `chosen` is empty.
[[nodiscard]] bool is_chosen(const std::vector<std::string>& chosen, const std::string& name);

/// Throws std::invalid_argument for an unknown name.
void check_names(const char* what, const std::vector<std::string>& names,
                 const std::vector<std::string>& known);

/// Registers a benchmark with ten repetitions that take `seconds` together.
void enlist(const std::string& title, double seconds,
            const std::function<void(benchmark::State&)>& run);

/// Runs the `count` registered benchmarks, with progress on stderr, and writes the last repetition
/// of each to the file. Returns false if one of them failed.
[[nodiscard]] bool run_enlisted(std::size_t count, bool to_file);

/// Machine, compiler, flags and commit, in one line.
[[nodiscard]] std::string build_line();

/// A complete main function: sorts the libraries, extracts the arguments of Google Benchmark, and
/// ends the process with the exit code that `run` returns, or 2 if it throws.
int start(int argc, char** argv, const char* about,
          int (*run)(const Arguments& arguments, bool to_file));

}  // namespace repel::bench
