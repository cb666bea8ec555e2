// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A benchmark made of parts: each measures, checks its measurements and makes a table.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <repel/host/command_line.hpp>

namespace repel::bench {

struct Options {
  bool quick = false;      ///< fewer and shorter runs, for a preview
  std::uint64_t seed = 1;  ///< seed of the random numbers, 0 to 1e9
};

using Json = nlohmann::ordered_json;

/// The results of a part.
struct Result {
  std::string title;
  std::vector<std::string> columns{};     ///< with units; the keys of the rows in the file
  std::vector<std::vector<Json>> rows{};  ///< numbers, text, booleans, or null where a check failed
  std::vector<std::string> notes{};       ///< one sentence each, below the table
  Json series = Json::object();           ///< curves for the plots, in the file only
  std::string failure{};                  ///< the first wrong row and why; empty: none

  /// Keeps only the first failure, with the row that begins with `words`.
  void fail(const std::string& words, const std::string& why) {
    if (failure.empty() && !why.empty()) failure = words + ": " + why;
  }
};

struct Part {
  const char* name;
  const char* about;  ///< one line
  Result (*run)(const Options&);
};

struct Program {
  const char* name;
  const char* about;          ///< one sentence
  std::span<const Part> all;  ///< in the order in which they run
  const char* seeded;         ///< meaning of the seed
  const char* footer;         ///< of the help: what the figures mean
  const char* scheduler;      ///< scheduler entry in the file
};

/// The command line of such a program.
struct PartArguments {
  std::vector<std::string> only;
  Options options;
  std::string json;
};

/// Registers the options of `program`, which write to `arguments`.
void describe(CLI::App& app, PartArguments& arguments, const Program& program);

/// Runs the selected parts, prints their tables and writes the file. Returns the exit status: 1 if
/// a result is wrong.
[[nodiscard]] int run(const PartArguments& arguments, const Program& program);

/// The main function of such a program. @tparam program with static storage
template <const Program& program>
[[nodiscard]] int start(int argc, char** argv) {
  return host::start<PartArguments>(
      argc, argv, program.name, program.about, 1,
      [](CLI::App& app, PartArguments& arguments) { describe(app, arguments, program); },
      [](const PartArguments& arguments) { return run(arguments, program); });
}

/// Shows on stderr how many rows of a part are done.
void progress(const char* part, std::size_t done, std::size_t of);

}  // namespace repel::bench
