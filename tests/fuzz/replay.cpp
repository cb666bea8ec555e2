// Runs a fuzz target without the fuzzer: on the files named, or on so many random inputs.
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

void run_random(long count) {
  std::mt19937_64 rng(1);
  std::vector<std::uint8_t> bytes;
  for (long i = 0; i < count; ++i) {
    bytes.resize(rng() % 512);
    for (std::uint8_t& b : bytes) b = static_cast<std::uint8_t>(rng());
    LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
  }
}

}  // namespace

int main(int argc, char** argv) {
  for (int i = 1; i < argc; ++i) {
    std::ifstream file(argv[i], std::ios::binary);
    if (!file) {
      run_random(std::strtol(argv[i], nullptr, 10));
      continue;
    }
    const std::string text(std::istreambuf_iterator<char>(file), {});
    std::printf("%s: %zu bytes\n", argv[i], text.size());
    const std::vector<std::uint8_t> bytes(text.begin(), text.end());
    LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
  }
  return 0;
}
