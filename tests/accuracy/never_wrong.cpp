// SPDX-License-Identifier: BSD-3-Clause
// Random pairs of polytopes, apart and in overlap, family by family, each compared with the exact
// answer. Exit status 1 if any invariant was violated.
#include <atomic>
#include <cinttypes>
#include <cstdio>
#include <mutex>
#include <thread>
#include <vector>

#include <accuracy/command_line.hpp>
#include <accuracy/trial.hpp>

namespace repel::accuracy {
namespace {

/// Number of pairs per shape: building a hull takes longer than a query.
constexpr int pairs_of_a_group = 20;
/// Interval of the pairs whose invariances are checked as well.
constexpr int invariances_every = 5;
constexpr int reports = 5;  ///< number of violations printed in full

struct Run {
  long groups = 0;
  std::uint64_t seed = 0;
  std::atomic<long> next{0};
  std::atomic<int> reported{0};
  std::mutex merging;
  Tally total;
};

void print_pose(const char* name, const Pose& X) {
  std::fprintf(stderr, "%s", name);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) std::fprintf(stderr, " %a", X(row, column));
  }
  std::fprintf(stderr, "\n");
}

void report(Run& run, long group, int index, const families::Pair& p, double truth) {
  if (run.reported.fetch_add(1) >= reports) return;
  const std::lock_guard lock(run.merging);
  std::fprintf(stderr, "broken: --seed %" PRIu64 " --group %ld, pair %d (%s), truth %.17g m\n",
               run.seed, group, index, families::names()[group % 13].c_str(), truth);
  for (const families::Solid* s : {&p.A, &p.B}) {
    for (const Vec3& v : s->vertices) std::fprintf(stderr, "  %a %a %a\n", v.x(), v.y(), v.z());
    std::fprintf(stderr, "  --\n");
  }
  print_pose("X_WA", p.X_WA);
  print_pose("X_WB", p.X_WB);
}

/// Poses of the family: a gap of 1e-9 to 1 m; of every eight pairs one up to 0.3 m in overlap and
/// one with the centres closer than the smaller size. Returns whether overlap is likely. If the
/// family cannot be separated, it stays in the overlap it was drawn with.
bool place(const std::string& family, int index, families::Pair& p, const Body& A, const Body& B,
           Rng& rng) {
  const bool shallow = index % 8 == 3;
  const bool deep = index % 8 == 7;
  const double gap =
      shallow ? -families::log_uniform(rng, 1e-9, 0.3) : families::log_uniform(rng, 1e-9, 1.0);
  for (int attempt = 0; attempt < 20; ++attempt) {
    families::draw_poses(family, p, rng);
    if (deep) {
      const double centres = families::uniform(rng, 0.0, std::min(A.size, B.size));
      p.X_WB.translation() = p.X_WA.translation() + centres * families::direction(rng);
      return true;
    }
    const auto found = oracle::distance(A.features, p.X_WA, B.features, p.X_WB);
    if (!found || !(found->distance > 0)) continue;
    p = families::shifted(p, found->normal, static_cast<double>(found->distance) - gap);
    return shallow;
  }
  return true;
}

void run_group(Run& run, long group, Tally& tally) {
  Rng rng(run.seed * 1000003ULL + static_cast<std::uint64_t>(group));
  const std::string& family = families::names()[group % 13];
  families::Pair p = families::draw_shapes(family, rng);
  const Body A(p.A, rng);
  const Body B(p.B, rng);
  for (int i = 0; i < pairs_of_a_group; ++i) {
    const bool overlap = place(family, i, p, A, B, rng);
    Trial trial(A, p.X_WA, B, p.X_WB, tally);
    if (trial.find_truth(overlap)) {
      trial.ask_cold_and_warm(rng);
      if (i % invariances_every == 0) trial.ask_invariances(rng);
    }
    if (trial.has_failed()) report(run, group, i, p, trial.truth());
  }
}

void work(Run& run) {
  Tally tally;
  for (long group = run.next++; group < run.groups; group = run.next++) {
    run_group(run, group, tally);
    if (run.groups >= 20 && (group + 1) % (run.groups / 20) == 0) {
      std::fprintf(stderr, "%3ld %%\n", 100 * (group + 1) / run.groups);
    }
  }
  const std::lock_guard lock(run.merging);
  run.total.add(tally);
}

int main(int argc, char** argv) {
  double pairs = 200000;
  double seed = 1;
  double threads = 1;
  double group = -1;
  read_command_line(
      argc, argv, "Compares the signed distance of random pairs of polytopes with the truth.",
      {{"--pairs", "how many pairs", &pairs, nullptr, pairs_of_a_group, 1e12},
       {"--seed", "of the random numbers", &seed},
       {"--threads", "the result does not depend on it", &threads, nullptr, 1.0, 1000.0},
       {"--group", "only this group of 20 pairs, as a report names it", &group}});
  Run run;
  run.seed = static_cast<std::uint64_t>(seed);
  run.groups = static_cast<long>(pairs) / pairs_of_a_group;
  if (group >= 0) {
    run.next = static_cast<long>(group);
    run.groups = run.next + 1;
  }
  std::vector<std::thread> workers;
  for (int i = 0; i < static_cast<int>(threads); ++i) workers.emplace_back([&] { work(run); });
  for (std::thread& worker : workers) worker.join();
  std::printf("seed %" PRIu64 "; invariances asked of every %dth pair\n", run.seed,
              invariances_every);
  run.total.print();
  return run.total.failures() == 0 && run.total.pairs > 0 ? 0 : 1;
}

}  // namespace
}  // namespace repel::accuracy

int main(int argc, char** argv) {
  return repel::accuracy::main(argc, argv);
}
