/// @file
/// What the programs that measure libraries side by side have in common.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

namespace repel::bench {

/// The words of a command line, taken out one by one.
class Arguments {
 public:
  /// The name of the program comes first and does not count.
  explicit Arguments(const std::vector<std::string>& words)
      : words_(words.begin() + 1, words.end()) {}

  /// Whether `flag` was given.
  [[nodiscard]] bool has(const std::string& flag);
  /// What follows `flag`, else `otherwise`. Throws std::invalid_argument where nothing follows.
  [[nodiscard]] std::string value(const std::string& flag, const std::string& otherwise);
  /// Throws std::invalid_argument when a word is left.
  void end() const;

 private:
  std::vector<std::string> words_;
};

/// The parts of a list "a,b,c".
[[nodiscard]] std::vector<std::string> split(const std::string& names);

/// True for every name where none was chosen.
[[nodiscard]] bool is_chosen(const std::vector<std::string>& chosen, const std::string& name);

/// Throws std::invalid_argument for a name that is not among those known.
void check_names(const char* what, const std::vector<std::string>& names,
                 const std::vector<std::string>& known);

/// Registers what is to be measured in ten repetitions of `seconds` together.
void enlist(const std::string& title, double seconds,
            const std::function<void(benchmark::State&)>& run);

/// Runs the `count` repeated benchmarks that were enlisted, progress on stderr, the last
/// repetition of each into the file. False when one of them failed.
[[nodiscard]] bool run_enlisted(std::size_t count, bool to_file);

/// The machine, the compiler, the flags and the commit, in one line.
[[nodiscard]] std::string build_line();

/// A whole main function: sorts the libraries, takes out what Google Benchmark knows, and ends the
/// process with the code that `run` returns, or 2 for what it throws.
int start(int argc, char** argv, const char* about,
          int (*run)(const Arguments& arguments, bool to_file));

}  // namespace repel::bench
