// SPDX-License-Identifier: BSD-3-Clause
// Runs a fuzz target without a fuzzer: on the given files, and on a number of random inputs, which
// are mutations of those files if there are any.
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include <fuzz/mutation.hpp>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

// Tokens of the parsed languages.
constexpr std::array<std::string_view, 24> words{
    ",", ":",  ": ",  "- ", "[",   "]",  "{",     "}",   "?",   "&a ",  "*a ",  "!",
    "|", "\"", "'\n", "#",  "\n ", "\t", "1e308", "nan", "<l>", "/>\n", "%%\n", "\xff"};

void run(const std::string& text) {
  const std::vector<std::uint8_t> bytes(text.begin(), text.end());
  LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
}

void run_random(long count, const std::vector<std::string>& seeds) {
  constexpr std::uint64_t seed = 1;
  std::printf("%ld inputs, seed %llu\n", count, static_cast<unsigned long long>(seed));
  std::mt19937_64 rng(seed);
  std::string bytes;
  for (long i = 0; i < count; ++i) {
    if (!seeds.empty()) {
      run(repel::fuzz::mutated(seeds[rng() % seeds.size()], rng, words));
      continue;
    }
    bytes.resize(rng() % 512);
    for (char& b : bytes) b = static_cast<char>(rng());
    run(bytes);
  }
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> seeds;
  for (int i = 1; i < argc; ++i) {
    std::ifstream file(argv[i], std::ios::binary);
    if (!file) {
      run_random(std::strtol(argv[i], nullptr, 10), seeds);
      continue;
    }
    seeds.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
    std::printf("%s: %zu bytes\n", argv[i], seeds.back().size());
    run(seeds.back());
  }
  return 0;
}
