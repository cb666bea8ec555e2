// SPDX-License-Identifier: BSD-3-Clause
// Searches for the pair of shapes that needs the most iterations, and publishes it.
#include <array>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <string>

#include <accuracy/adversary.hpp>
#include <accuracy/command_line.hpp>

namespace repel::accuracy {
namespace {

/// Two kinds, and the largest number of iterations found for them.
struct Bout {
  const char* a;
  const char* b;
  std::array<int, 2> most{};  ///< cold, warm
  std::array<Duel, 2> worst{};
  long answers = 0;
};

std::string row(const Bout& bout) {
  const auto name = [](const char* kind) {
    return std::isdigit(kind[0]) != 0 ? "hull " + std::string(kind) : std::string(kind);
  };
  return "| " + name(bout.a) + ", " + name(bout.b) + " | " + std::to_string(bout.most[0]) + " | " +
         std::to_string(bout.most[1]) + " | " + std::to_string(bout.answers) + " |\n";
}

void search(Bout& bout, double seconds, Rng& rng) {
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + std::chrono::duration<double>(seconds);
  constexpr int tries = 300;
  for (int round = 0; round < 2 || Clock::now() < end; ++round) {
    const int warm = round % 2;
    climb(bout.a, bout.b, warm == 1, tries, rng, bout.worst[warm], bout.most[warm]);
    bout.answers += tries;
  }
}

/// Replaces everything from the heading on; the tables before it are kept.
void publish(const std::string& file, const std::string& section) {
  std::ifstream in(file);
  std::string page(std::istreambuf_iterator<char>(in), {});
  page = page.substr(0, page.find("\n## Worst case"));
  std::ofstream(file) << page << section;
}

int main(int argc, char** argv) {
  double seconds = 60;
  double seed = 1;
  std::string write;
  read_command_line(argc, argv,
                    "Searches for the pairs of shapes that take separation() most iterations.",
                    {{"--seconds", "how long to search", &seconds, nullptr, 0.0, 1e6},
                     {"--seed", "of the random numbers", &seed},
                     {"--write", "the page that gets the result", nullptr, &write}});
  std::array<Bout, 9> bouts{{{"box", "box"},
                             {"box", "16"},
                             {"16", "16"},
                             {"64", "64"},
                             {"1000", "1000"},
                             {"capsule", "16"},
                             {"box", "cylinder"},
                             {"64", "cylinder"},
                             {"cylinder", "cylinder"}}};
  Rng rng(static_cast<std::uint64_t>(seed));
  std::string section =
      "\n## Worst case\n\nThe largest number of iterations of `separation` that an adversarial "
      "search has found, by\nrandom restarts and hill climbing over sizes, attitudes and "
      "positions, with gaps of 1 nm to\n1 m and overlap. Warm means started from the result for a "
      "pose 0.5 mm and 0.1 degree away.\nThe cap is 256 in each precision. `worst_case --seconds " +
      std::to_string(static_cast<long>(seconds)) + " --seed " +
      std::to_string(static_cast<long>(seed)) +
      " --write docs/accuracy.md`\nrepeats the search.\n\n| shapes | cold | warm | answers |\n"
      "|---|---|---|---|\n";
  bool under_cap = true;
  for (Bout& bout : bouts) {
    search(bout, seconds / bouts.size(), rng);
    section += row(bout);
    for (int warm = 0; warm < 2; ++warm) {
      std::printf("%s, %s, %s: %d iterations\n", bout.a, bout.b, warm == 0 ? "cold" : "warm",
                  bout.most[warm]);
      bout.worst[warm].print();
      under_cap = under_cap && bout.most[warm] <= 2 * 256 + 13;
    }
  }
  if (!write.empty()) publish(write, section);
  return under_cap ? 0 : 1;
}

}  // namespace
}  // namespace repel::accuracy

int main(int argc, char** argv) {
  return repel::accuracy::main(argc, argv);
}
