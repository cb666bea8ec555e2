/// @file
/// What a near pair costs in a tick, against a warm query of the same pair in the same run.
///
/// A tool of many parts moves at 0.28 m/s and 400 ticks per second past as many obstacles; every
/// pair stays within range. Each tick is timed, and beside it the warm queries of the same pairs at
/// the same poses, one after the other. `raw_ns` and `tick_ns` are medians per near pair.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <random>
#include <repel/repel.hpp>

#include "harness.hpp"

namespace {

using namespace repel;
using Clock = std::chrono::steady_clock;

constexpr std::uint64_t seed = 20;
constexpr std::size_t positions = 128;
using Rng = std::mt19937_64;

double uniform(Rng& rng, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(rng);
}
Vec3 direction(Rng& rng) {
  std::normal_distribution<double> normal;
  return Vec3(normal(rng), normal(rng), normal(rng)).normalized();
}
Mat3 any_turn(Rng& rng) {
  return Eigen::Quaterniond(Eigen::Vector4d::Random()).normalized().toRotationMatrix() *
         Eigen::AngleAxisd(uniform(rng, 0.0, 3.0), direction(rng));
}

struct Scene {
  const char* name;
  bool are_hulls;      ///< of 16 corners, else boxes
  bool are_parallel;   ///< faces, within the tilt
  double overlapping;  ///< share of the pairs
};
constexpr Scene scenes[] = {{"boxes", false, false, 0.0},
                            {"parallel boxes", false, true, 0.0},
                            {"hulls of 16 corners", true, false, 0.0},
                            {"parallel hulls of 16 corners", true, true, 0.0},
                            {"boxes and hulls, a tenth in overlap", false, false, 0.1},
                            {"parallel boxes and hulls, a tenth in overlap", false, true, 0.1}};

Shape random_shape(Rng& rng, bool is_hull, bool is_parallel) {
  if (!is_hull) {
    return Shape::box({uniform(rng, 0.03, 0.08), uniform(rng, 0.03, 0.08), 0.04});
  }
  std::vector<Vec3> points;
  for (int i = 0; i < 16; ++i) {
    const double angle = M_PI / 4.0 * (i / 2);
    points.push_back(is_parallel ? Vec3(0.05 * std::cos(angle), 0.05 * std::sin(angle),
                                        i % 2 == 0 ? -0.04 : 0.04)
                                 : Vec3(0.06 * direction(rng)));
  }
  return Shape::hull(points);
}

/// The tool, its obstacles, and its poses.
struct Setting {
  World world;
  BodyId tool = world.add_body("tool");
  std::vector<Pose> X_WT;

  Setting(const Scene& scene, int pairs) {
    Rng rng(seed);
    for (int i = 0; i < pairs; ++i) {
      const bool is_hull = scene.are_hulls || (scene.overlapping > 0.0 && i % 2 == 1);
      const Shape A = random_shape(rng, is_hull, scene.are_parallel);
      const Shape B = random_shape(rng, is_hull, scene.are_parallel);
      const bool overlaps = scene.overlapping > 0.0 && i % 10 == 3;
      Pose X_A = Pose::Identity();
      Pose X_B = Pose::Identity();
      X_B.translation() = Vec3(0.5 * (i % 20), 0.5 * (i / 20), 0.0);
      X_A.translation() = X_B.translation();
      if (scene.are_parallel) {
        X_A.linear() = Eigen::AngleAxisd(uniform(rng, -0.004, 0.004), Vec3::UnitX()) *
                       Eigen::AngleAxisd(uniform(rng, -3.0, 3.0), Vec3::UnitZ()).toRotationMatrix();
        X_A.translation() +=
            Vec3(uniform(rng, -0.03, 0.03), uniform(rng, -0.03, 0.03), overlaps ? 0.065 : 0.1);
      } else {
        X_A.linear() = any_turn(rng);
        X_B.linear() = any_turn(rng);
        const Vec3 away = direction(rng);
        const double wanted = overlaps ? -0.012 : 0.02;
        double low = 0.0, high = 1.0;
        while (high - low > 1e-4) {
          const double middle = 0.5 * (low + high);
          Pose X = X_A;
          X.translation() += middle * away;
          (separation(A, X, B, X_B).distance > wanted ? high : low) = middle;
        }
        X_A.translation() += high * away;
      }
      world.add_pair(world.add_part(tool, "part", A, X_A),
                     world.add_part(World::fixed, "obstacle", B, X_B), {.range = 0.06});
    }
    // A slanted circle of 90 mm and a turn of two milliradians.
    for (std::size_t k = 0; k < positions; ++k) {
      const double angle = 2.0 * M_PI * static_cast<double>(k) / positions;
      const double radius = 0.0007 * positions / (2.0 * M_PI);
      Pose X = Pose::Identity();
      X.translation() =
          radius * Vec3(0.6 * std::cos(angle), std::sin(angle), 0.5 * std::cos(angle));
      X.linear() = Eigen::AngleAxisd(1e-4 * std::sin(angle), Vec3::UnitY()).toRotationMatrix();
      X_WT.push_back(X);
    }
  }
};

double median(std::vector<double>& all) {
  std::nth_element(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2),
                   all.end());
  return all[all.size() / 2];
}

void near_pair(benchmark::State& state) {
  const Scene& scene = scenes[state.range(0)];
  const auto pairs = static_cast<std::size_t>(state.range(1));
  Setting setting(scene, static_cast<int>(pairs));
  World& world = setting.world;
  std::vector<std::vector<Pose>> X_WA(positions);
  for (std::size_t k = 0; k < positions; ++k) {
    for (const Pair& pair : world.pairs()) {
      X_WA[k].push_back(setting.X_WT[k] * world.part(pair.a).X_BP);
    }
  }
  std::vector<WarmStart> warm(pairs);
  Coprocessor coprocessor(world, {});
  std::vector<double> raw_ns, tick_ns;
  double near = 0.0, overlapping = 0.0;
  std::size_t tick = 0;
  const auto since = [](Clock::time_point start) {
    return std::chrono::duration<double, std::nano>(Clock::now() - start).count();
  };
  for (auto _ : state) {
    const std::size_t at = tick++ % positions;
    const auto start = Clock::now();
    for (std::size_t i = 0; i < pairs; ++i) {
      const Pair& pair = world.pairs()[i];
      const Separation s =
          separation(world.part(pair.a).shape, X_WA[at][i], world.part(pair.b).shape,
                     world.part(pair.b).X_BP, world.query_options(), warm[i]);
      benchmark::DoNotOptimize(s);
      overlapping += s.distance < 0.0 ? 1.0 : 0.0;
    }
    const double raw = since(start);
    world.motion().tick = static_cast<std::int64_t>(tick);
    world.place(setting.tool, setting.X_WT[at], {});
    const auto begin = Clock::now();
    const PairForces& forces = coprocessor.exchange();
    const double whole = since(begin);
    state.SetIterationTime(1e-9 * whole);
    near += forces.totals.near;
    raw_ns.push_back(raw / static_cast<double>(pairs));
    tick_ns.push_back(whole / std::max(1, forces.totals.near));
  }
  const double all = static_cast<double>(tick);
  state.counters["near"] = near / all;
  state.counters["overlapping"] = overlapping / all;
  state.counters["raw_ns"] = median(raw_ns);
  state.counters["tick_ns"] = median(tick_ns);
  state.counters["ratio"] = median(tick_ns) / median(raw_ns);
  state.SetLabel(scene.name);
}

}  // namespace

BENCHMARK(near_pair)
    ->ArgNames({"scene", "pairs"})
    ->ArgsProduct({{0, 1, 2, 3, 4, 5}, {16, 100, 300}})
    ->UseManualTime();

int main(int argc, char** argv) {
  return repel::bench::run_benchmarks(argc, argv,
                                      "near_pairs: a near pair in a tick against its warm query.");
}
