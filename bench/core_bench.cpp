// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Cost of one query and one tick: pairs of boxes and hulls, cold and warm, and the tick of 4 tool
/// parts against 8 obstacles, with every pair near and with most of them skipped; and what the
/// contact patch adds to a warm query.
///
/// Warm means solved one tick earlier, then moved by 0.5 mm and 0.1 degree. Answers are checked
/// before the timing: cold and warm must agree, and the bracket must contain both.

#include <benchmark/benchmark.h>

#include <cmath>
#include <repel/control.hpp>
#include <repel/repel.hpp>
#include <support/families.hpp>

#include "harness.hpp"

namespace {

using namespace repel;

constexpr std::uint64_t seed = 20;
using families::direction;
using families::Rng;
using families::small_rotation;
using families::uniform;

/// `vertices` 0: a box, else a hull of that many points on a sphere.
Shape random_shape(Rng& rng, std::int64_t vertices) {
  if (vertices == 0) {
    return Shape::box({uniform(rng, 0.1, 0.5), uniform(rng, 0.1, 0.5), uniform(rng, 0.1, 0.5)});
  }
  std::vector<Vec3> points;
  for (std::int64_t i = 0; i < vertices; ++i) points.push_back(0.5 * direction(rng));
  return Shape::hull(points, {.levels = 1});
}

/// A pair of separated shapes, at two poses of B one tick apart.
struct Case {
  Shape A, B;
  Pose X_WA = Pose::Identity();
  Pose X_WB[2] = {Pose::Identity(), Pose::Identity()};
  WarmStart warm{};
};

std::vector<Case> cases(std::int64_t vertices) {
  Rng rng(seed);
  std::vector<Case> all;
  for (int i = 0; i < 256; ++i) {
    Case c{.A = random_shape(rng, vertices), .B = random_shape(rng, vertices)};
    c.X_WA.linear() = small_rotation(rng, uniform(rng, 0.0, 3.0));
    c.X_WB[0].linear() = small_rotation(rng, uniform(rng, 0.0, 3.0));
    c.X_WB[0].translation() = uniform(rng, 1.4, 2.5) * direction(rng);
    c.X_WB[1] = c.X_WB[0];
    c.X_WB[1].translation() += 0.0005 * direction(rng);
    c.X_WB[1].linear() = small_rotation(rng, 0.1 * M_PI / 180.0) * c.X_WB[0].linear();
    all.push_back(std::move(c));
  }
  return all;
}

/// Solves every case cold and warm; false if they disagree.
bool answers_hold(std::vector<Case>& all) {
  for (Case& c : all) {
    (void)separation(c.A, c.X_WA, c.B, c.X_WB[1], {}, c.warm);
    const Separation warm = separation(c.A, c.X_WA, c.B, c.X_WB[0], {}, c.warm);
    const Separation cold = separation(c.A, c.X_WA, c.B, c.X_WB[0]);
    if (std::abs(warm.distance - cold.distance) > 1e-12 || warm.distance > cold.upper ||
        warm.distance < cold.lower || !(cold.distance > 0.0)) {
      return false;
    }
  }
  return true;
}

void pair_cold(benchmark::State& state) {
  std::vector<Case> all = cases(state.range(0));
  if (!answers_hold(all)) return state.SkipWithError("wrong answer");
  std::size_t i = 0;
  for (auto _ : state) {
    const Case& c = all[i++ % all.size()];
    benchmark::DoNotOptimize(separation(c.A, c.X_WA, c.B, c.X_WB[0]));
  }
}

void pair_warm(benchmark::State& state) {
  std::vector<Case> all = cases(state.range(0));
  if (!answers_hold(all)) return state.SkipWithError("wrong answer");
  std::size_t i = 0;
  for (auto _ : state) {
    Case& c = all[i % all.size()];
    benchmark::DoNotOptimize(separation(c.A, c.X_WA, c.B, c.X_WB[i / all.size() % 2], {}, c.warm));
    ++i;
  }
}

/// Pairs over each other, a few mrad from parallel: faces of boxes, faces of hexagonal prisms, the
/// side of a cylinder on a box; and boxes that are not parallel.
std::vector<Case> contacts(std::int64_t kind) {
  Rng rng(seed);
  std::vector<Vec3> prism;
  for (int i = 0; i < 12; ++i) {
    const double angle = M_PI / 3.0 * (i / 2);
    prism.emplace_back(0.05 * std::cos(angle), 0.05 * std::sin(angle), i % 2 == 0 ? -0.04 : 0.04);
  }
  std::vector<Case> all;
  for (int i = 0; i < 256; ++i) {
    const Shape block = Shape::box({uniform(rng, 0.03, 0.08), uniform(rng, 0.03, 0.08), 0.04});
    const Shape upper = kind == 1   ? Shape::hull(prism, {.levels = 1})
                        : kind == 2 ? Shape::cylinder(0.04, uniform(rng, 0.03, 0.08))
                                    : block;
    Case c{.A = Shape::box({0.06, 0.06, 0.03}), .B = upper};
    if (kind == 1) c.A = upper;
    for (Pose& X : c.X_WB) {
      const Mat3 up = kind == 2 ? Eigen::AngleAxisd(M_PI / 2.0, Vec3::UnitY()).toRotationMatrix()
                                : Mat3(Eigen::AngleAxisd(uniform(rng, 0.0, 3.0), Vec3::UnitZ()));
      X.linear() = kind == 3 ? small_rotation(rng, uniform(rng, 0.5, 3.0))
                             : Mat3(small_rotation(rng, 0.004) * up);
      X.translation() = Vec3(uniform(rng, -0.04, 0.04), uniform(rng, -0.04, 0.04), 0.09);
      if (kind == 3) X.translation().z() = 0.15;
    }
    c.X_WB[1].translation() = c.X_WB[0].translation() + 5e-4 * direction(rng);
    c.X_WB[1].linear() = small_rotation(rng, 0.1 * M_PI / 180.0) * c.X_WB[0].linear();
    all.push_back(std::move(c));
  }
  return all;
}

/// A warm query and, with `with_patch`, the contact patch on its answer.
void contact(benchmark::State& state, bool with_patch) {
  std::vector<Case> all = contacts(state.range(0));
  int patches = 0;
  for (Case& c : all) {
    const Separation s = separation(c.A, c.X_WA, c.B, c.X_WB[0], {}, c.warm);
    ContactPatch patch;
    if (!(s.distance > 0.0)) return state.SkipWithError("not apart");
    if (!find_patch(s, {c.A, c.X_WA}, {c.B, c.X_WB[0]}, 0.005, patch)) continue;
    ++patches;
    if (std::abs(patch.gradient.force.norm() - 1.0) > 0.01) state.SkipWithError("wrong force");
  }
  std::size_t i = 0;
  for (auto _ : state) {
    Case& c = all[i % all.size()];
    const Pose& X_WB = c.X_WB[i / all.size() % 2];
    const Separation s = separation(c.A, c.X_WA, c.B, X_WB, {}, c.warm);
    ContactPatch patch;
    if (with_patch) (void)find_patch(s, {c.A, c.X_WA}, {c.B, X_WB}, 0.005, patch);
    benchmark::DoNotOptimize(s);
    benchmark::DoNotOptimize(patch);
    ++i;
  }
  state.counters["with_patch"] = patches / static_cast<double>(all.size());
  static const char* const names[] = {"box on box", "hull on hull", "cylinder side on box",
                                      "not parallel"};
  state.SetLabel(names[state.range(0)]);
}
void warm(benchmark::State& state) {
  contact(state, false);
}
void patch(benchmark::State& state) {
  contact(state, true);
}

/// 4 tool boxes and 8 obstacle boxes. `range` [m] decides how many of the 32 pairs are near.
void tick_4x8(benchmark::State& state) {
  Rng rng(seed);
  World world;
  const BodyId tool = world.add_body("tool");
  const ForceLaw law{.range = 1e-3 * static_cast<double>(state.range(0))};
  std::vector<PartId> parts;
  for (int i = 0; i < 4; ++i) {
    Pose X = Pose::Identity();
    X.translation() = 0.05 * direction(rng);
    parts.push_back(world.add_part(tool, "part", Shape::box({0.03, 0.04, 0.05}), X));
  }
  for (int i = 0; i < 8; ++i) {
    Pose X = Pose::Identity();
    X.translation() = uniform(rng, 0.3, 0.5) * direction(rng);
    X.linear() = small_rotation(rng, uniform(rng, 0.0, 3.0));
    const PartId wall = world.add_part(World::fixed, "wall", Shape::box({0.05, 0.1, 0.07}), X);
    for (const PartId part : parts) world.add_pair(part, wall, law);
  }
  Coprocessor coprocessor(world, {});
  double near = 0.0;
  std::int64_t tick = 0;
  for (auto _ : state) {
    const double angle = 1e-3 * static_cast<double>(tick);
    Pose X = Pose::Identity();
    X.translation() = 0.05 * Vec3(std::sin(angle), std::sin(1.3 * angle), std::sin(1.7 * angle));
    world.motion().tick = tick++;
    world.place(tool, X, {});
    const PairForces& forces = coprocessor.exchange();
    near += forces.totals.near;
    benchmark::DoNotOptimize(forces.on_body.data());
  }
  state.counters["near_pairs"] = near / static_cast<double>(tick);
}

}  // namespace

BENCHMARK(pair_cold)->ArgName("vertices")->Arg(0)->Arg(8)->Arg(16)->Arg(32)->Arg(64)->Arg(256);
BENCHMARK(pair_warm)->ArgName("vertices")->Arg(0)->Arg(8)->Arg(16)->Arg(32)->Arg(64)->Arg(256);
BENCHMARK(warm)->ArgName("contact")->DenseRange(0, 3);
BENCHMARK(patch)->ArgName("contact")->DenseRange(0, 3);
BENCHMARK(tick_4x8)->ArgName("range_mm")->Arg(20)->Arg(2000);

int main(int argc, char** argv) {
  return repel::bench::run_benchmarks(argc, argv,
                                      "core_bench: what one query and one tick of the core cost.");
}
