/// @file
/// What every benchmark program has in common: `--json FILE`, and what the file says about the
/// machine and the build.
#pragma once

#include <string>
#include <vector>

#include <benchmark/benchmark.h>

namespace repel::bench {

/// The machine and the build, in words.
struct Build {
  std::string machine;   ///< model of the processor, number of them
  std::string compiler;  ///< name and version
  std::string flags;     ///< that the program was compiled with
  std::string simd;      ///< widest vector registers that were compiled for
  std::string commit;    ///< "unknown" outside a git checkout
};
[[nodiscard]] Build this_build();

/// Hands the arguments to Google Benchmark, `--json FILE` as its own output flags, and adds
/// this_build() to what it writes. Returns what it did not know, the name of the program first.
[[nodiscard]] std::vector<std::string> initialize(int argc, char** argv);

/// A whole main function: initialize, run, report. `--help` prints `about` and Google Benchmark's
/// own flags. Returns the exit code: 2 for an argument nobody knows.
[[nodiscard]] int run_benchmarks(int argc, char** argv, const char* about);

}  // namespace repel::bench
