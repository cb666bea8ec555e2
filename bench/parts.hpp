/// @file
/// A benchmark that is made of parts: each measures, checks what it measured and makes a table.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "command_line.hpp"

namespace repel::bench {

struct Options {
  bool quick = false;      ///< fewer and shorter runs: a look, not a result
  std::uint64_t seed = 1;  ///< of what is drawn at random, 0 to 1e9
};

using Json = nlohmann::ordered_json;

/// What a part has measured.
struct Result {
  std::string title;
  std::vector<std::string> columns{};     ///< with units; the keys of the rows in the file
  std::vector<std::vector<Json>> rows{};  ///< numbers, words, true and false, or null: not earned
  std::vector<std::string> notes{};       ///< a sentence each, below the table
  Json series = Json::object();           ///< curves for the plots, in the file alone
  std::string failure{};                  ///< the row that is wrong and why; empty: none is

  /// Keeps the first failure, of the row that begins with `words`.
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
  const char* seeded;         ///< what the seed is of
  const char* footer;         ///< of the help: what the figures are
  const char* scheduler;      ///< what the file says of the clock
};

/// The command line of such a program.
struct PartArguments {
  std::vector<std::string> only;
  Options options;
  std::string json;
};

/// Tells the options of `program`, which write to `arguments`.
void describe(CLI::App& app, PartArguments& arguments, const Program& program);

/// Runs the parts asked for, prints their tables and writes the file. Returns the exit status: 1
/// when a result is wrong.
[[nodiscard]] int run(const PartArguments& arguments, const Program& program);

/// Shows on stderr how many rows of a part are done.
void progress(const char* part, std::size_t done, std::size_t of);

}  // namespace repel::bench
