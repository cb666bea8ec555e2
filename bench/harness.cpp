// SPDX-License-Identifier: BSD-3-Clause
#include "harness.hpp"

#include <cstdio>
#include <cstring>
#include <fstream>
#include <thread>

#include "commit.hpp"

namespace repel::bench {

namespace {

std::string processor() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    if (line.rfind("model name", 0) == 0) return line.substr(line.find(':') + 2);
  }
  return "unknown processor";
}

constexpr const char* simd() {
#if defined(__AVX512F__)
  return "AVX-512";
#elif defined(__AVX2__)
  return "AVX2";
#elif defined(__AVX__)
  return "AVX";
#elif defined(__SSE2__)
  return "SSE2";
#else
  return "portable";
#endif
}

constexpr const char* compiler() {
#if defined(__clang__)
  return "clang " __clang_version__;
#else
  return "g++ " __VERSION__;
#endif
}

}  // namespace

Build this_build() {
  return {processor() + ", " + std::to_string(std::thread::hardware_concurrency()) + " threads",
          compiler(), REPEL_BENCH_FLAGS, simd(), host::commit};
}

std::vector<std::string> initialize(int argc, char** argv) {
  // Google Benchmark keeps pointers to them.
  static std::vector<std::string> arguments;
  arguments.assign(argv, argv + argc);
  for (std::size_t i = 1; i + 1 < arguments.size(); ++i) {
    if (arguments[i] != "--json") continue;
    arguments[i] = "--benchmark_out=" + arguments[i + 1];
    arguments[i + 1] = "--benchmark_out_format=json";
  }
  std::vector<char*> pointers;
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  int count = static_cast<int>(pointers.size());
  benchmark::Initialize(&count, pointers.data());
  const Build build = this_build();
  benchmark::AddCustomContext("machine", build.machine);
  benchmark::AddCustomContext("compiler", build.compiler);
  benchmark::AddCustomContext("flags", build.flags);
  benchmark::AddCustomContext("simd", build.simd);
  benchmark::AddCustomContext("commit", build.commit);
  return {pointers.begin(), pointers.begin() + count};
}

int run_benchmarks(int argc, char** argv, const char* about) {
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--help") == 0) {
      std::printf("%s\n\n  --json FILE  writes the results as JSON\n\n", about);
    }
  }
  const std::vector<std::string> unknown = initialize(argc, argv);
  if (unknown.size() > 1) {
    std::fprintf(stderr, "unknown argument: %s (see --help)\n", unknown[1].c_str());
    return 2;
  }
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}

}  // namespace repel::bench
