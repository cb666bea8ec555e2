// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What the benchmark programs share: the description of machine and build, and for those of Google
/// Benchmark the way from their arguments to `--json FILE` with that description in it.
#pragma once

#include <string>
#include <vector>

#include <benchmark/benchmark.h>

namespace repel::bench {

/// Description of the machine and the build.
struct Build {
  std::string machine;   ///< model and number of processors
  std::string compiler;  ///< name and version
  std::string flags;     ///< compiler flags of this program
  std::string simd;      ///< widest SIMD extension compiled for
  std::string commit;    ///< "unknown" outside a git checkout
};
[[nodiscard]] Build this_build();

/// Passes the arguments to Google Benchmark, `--json FILE` as its own output flags, and adds
/// this_build() to the output. Returns the arguments it did not recognize, after the program name.
[[nodiscard]] std::vector<std::string> initialize(int argc, char** argv);

/// A complete main function: initialize, run, report. `--help` prints `about` and Google
/// Benchmark's own flags. Returns the exit code: 2 for an unknown argument.
[[nodiscard]] int run_benchmarks(int argc, char** argv, const char* about);

}  // namespace repel::bench
