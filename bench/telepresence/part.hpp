/// @file
/// What a part of the benchmark is: a name and a function that makes a table.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace repel::telepresence {

struct Options {
  bool quick = false;      ///< fewer and shorter runs: a look, not a result
  std::uint64_t seed = 1;  ///< of the channels of the lines, 0 to 1e9
};

using Json = nlohmann::ordered_json;

/// What a part has measured.
struct Result {
  std::string title;
  std::vector<std::string> columns{};     ///< with units; the keys of the rows in the file
  std::vector<std::vector<Json>> rows{};  ///< numbers, words, or true and false
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

/// All of them, in the order in which they run.
[[nodiscard]] std::span<const Part> parts();

/// Shows on stderr how many rows of a part are done.
void progress(const char* part, std::size_t done, std::size_t of);

[[nodiscard]] Result delay(const Options& options);
[[nodiscard]] Result transparency(const Options& options);
[[nodiscard]] Result zwidth(const Options& options);
[[nodiscard]] Result hold(const Options& options);
// On the simulated arm; only where it is built.
[[nodiscard]] Result contact(const Options& options);
[[nodiscard]] Result align(const Options& options);
[[nodiscard]] Result relief(const Options& options);
[[nodiscard]] Result joint_limits(const Options& options);
[[nodiscard]] Result reflection(const Options& options);

}  // namespace repel::telepresence
