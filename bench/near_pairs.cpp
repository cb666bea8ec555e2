// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What a near pair costs in a tick, against a warm query of the same pair in the same run.
///
/// A tool of many parts moves at 0.28 m/s and 400 ticks per second past as many obstacles; every
/// pair stays within range. Each tick is timed, and beside it the warm queries of the same pairs at
/// the same poses, one after the other. `raw_ns` and `tick_ns` are medians per near pair.
/// Answers are checked before the timing: the force on the tool must be that of the queries.
/// `least_ns` is what the formulas of distance and patch take alone, with all lanes full and the
/// pairs where they are: without them, no tick is faster. It is of the pairs that are apart.
///
/// Where MuJoCo is there, the contacts that it finds between the same pairs at the same poses.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <cmath>
#include <repel/contact/polygon_search.hpp>
#include <repel/control.hpp>
#include <repel/repel.hpp>
#include <support/families.hpp>

#include "harness.hpp"
#ifdef REPEL_BENCH_MUJOCO
#include "mujoco_contacts.hpp"
#endif

namespace {

using namespace repel;
using Clock = std::chrono::steady_clock;

constexpr std::uint64_t seed = 20;
constexpr std::size_t positions = 128;
constexpr double range = 0.06;  ///< [m] within which a pair is near
using families::direction;
using families::Rng;
using families::Solid;
using families::uniform;

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

Solid random_solid(Rng& rng, bool is_hull, bool is_parallel) {
  if (!is_hull) {
    return {{}, true, {uniform(rng, 0.03, 0.08), uniform(rng, 0.03, 0.08), 0.04}};
  }
  std::vector<Vec3> points;
  for (int i = 0; i < 16; ++i) {
    const double angle = M_PI / 4.0 * (i / 2);
    points.push_back(is_parallel ? Vec3(0.05 * std::cos(angle), 0.05 * std::sin(angle),
                                        i % 2 == 0 ? -0.04 : 0.04)
                                 : Vec3(0.06 * direction(rng)));
  }
  return {points};
}

Shape shape(const Solid& s) {
  return s.box ? Shape::box(s.half_extents) : Shape::hull(s.vertices);
}

/// The tool, its obstacles, and its poses.
struct Setting {
  World world;
  BodyId tool = world.add_body("tool");
  std::vector<families::Pair> solids;  ///< of the pairs: A in the tool, B in the world
  std::vector<Pose> X_WT;

  Setting(const Scene& scene, int pairs) {
    Rng rng(seed);
    for (int i = 0; i < pairs; ++i) {
      const bool is_hull = scene.are_hulls || (scene.overlapping > 0.0 && i % 2 == 1);
      const Solid solid_A = random_solid(rng, is_hull, scene.are_parallel);
      const Solid solid_B = random_solid(rng, is_hull, scene.are_parallel);
      const Shape A = shape(solid_A);
      const Shape B = shape(solid_B);
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
        X_A.linear() = families::rotation(rng);
        X_B.linear() = families::rotation(rng);
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
                     world.add_part(World::fixed, "obstacle", B, X_B), {.range = range});
      solids.push_back({solid_A, solid_B, X_A, X_B});
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

double ns_since(Clock::time_point start) {
  return std::chrono::duration<double, std::nano>(Clock::now() - start).count();
}

double median(std::vector<double>& all) {
  std::nth_element(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2),
                   all.end());
  return all[all.size() / 2];
}

/// The force on the tool at rest, about its origin, by one query and one patch for each pair.
Wrench force_by_queries(const World& world, const Pose& X_WT, std::vector<WarmStart>& warm) {
  Wrench on_tool;
  for (std::size_t i = 0; i < warm.size(); ++i) {
    const Pair& pair = world.pairs()[i];
    const Shape& A = world.part(pair.a).shape;
    const Shape& B = world.part(pair.b).shape;
    const Pose X_WA = X_WT * world.part(pair.a).X_BP;
    const Pose& X_WB = world.part(pair.b).X_BP;
    const Separation s = separation(A, X_WA, B, X_WB, world.query_options(), warm[i]);
    ContactPatch patch{.gradient = {s.extraction_W}};
    (void)find_patch(s, {A, X_WA}, {B, X_WB}, pair.law.tilt, patch);
    const double distance = (s.lower > 0.0 ? s.lower : s.distance) - patch.nearer;
    on_tool += moved_to(pair.law(distance, 0.0) * patch.gradient, X_WT.translation() - s.p_WA);
  }
  return on_tool;
}

/// Whether ticks give those forces, to 1e-8 of them or of 1 N.
bool is_right(const Scene& scene, int pairs) {
  Setting setting(scene, pairs);
  World& world = setting.world;
  Coprocessor coprocessor(world, {});
  std::vector<WarmStart> warm(static_cast<std::size_t>(pairs));
  for (std::size_t k = 0; k < positions; ++k) {
    world.motion().tick = static_cast<std::int64_t>(k) + 1;
    world.place(setting.tool, setting.X_WT[k], {});
    const Wrench found = coprocessor.exchange().on_body[1];
    const Wrench wanted = force_by_queries(world, setting.X_WT[k], warm);
    const double off = norm(found.force - wanted.force) + norm(found.torque - wanted.torque);
    if (!(off <= 1e-8 * (1.0 + norm(wanted.force) + norm(wanted.torque)))) return false;
  }
  return true;
}

/// Pairs that are apart in lanes, at the first pose of the tool, those of two boxes first.
class FullLanes {
 public:
  explicit FullLanes(const Setting& setting) : world_(setting.world) {
    std::vector<int> order;
    for (const bool boxes : {true, false}) {
      for (int i = 0; i < static_cast<int>(world_.pairs().size()); ++i) {
        if (are_boxes(i) == boxes) order.push_back(i);
      }
    }
    int count = 0;
    for (const int i : order) {
      const Pair& pair = world_.pairs()[static_cast<std::size_t>(i)];
      const Part& a = world_.part(pair.a);
      const Part& b = world_.part(pair.b);
      const Pose X_WA = setting.X_WT[0] * a.X_BP;
      WarmStart warm;
      const Separation s = separation(a.shape, X_WA, b.shape, b.X_BP, world_.query_options(), warm);
      if (!(s.distance > 0.0)) continue;
      const int k = count++ % detail::lane_count;
      if (k == 0) groups_.emplace_back();
      Group& group = groups_.back();
      group.features.set(k, a.shape.level(0).core, b.shape.level(0).core, warm);
      group.features.A.X_W.set(k, X_WA);
      group.features.B.X_W.set(k, b.X_BP);
      group.features.B.turn();
      group.tilt[k] = pair.law.tilt;
      group.X_WA[static_cast<std::size_t>(k)] = X_WA;
      group.X_WB[static_cast<std::size_t>(k)] = b.X_BP;
    }
    if (count % detail::lane_count != 0) groups_.pop_back();
  }
  [[nodiscard]] int pairs() const { return static_cast<int>(groups_.size()) * detail::lane_count; }
  /// Evaluates all of them. Returns how many lanes have no distance, or no patch if they should.
  int evaluate(bool with_patches) {
    unsigned missing = 0;
    for (Group& group : groups_) {
      group.features.A.turn();
      const detail::LaneGap gap = group.features.prove({});
      detail::LaneMask found = gap.proven;
      if (with_patches) {
        detail::PolygonSearch search(group.features, gap, group.tilt);
        search.find_flats(
            found, [&](int k) -> const Pose& { return group.X_WA[static_cast<std::size_t>(k)]; },
            [&](int k) -> const Pose& { return group.X_WB[static_cast<std::size_t>(k)]; },
            group.faces_a, group.faces_b);
        const detail::PolygonPatches few = search.patches<4>(found, detail::Lanes{});
        const detail::PolygonPatches many =
            search.patches<detail::PolygonLanes::most>(found, detail::Lanes{});
        benchmark::DoNotOptimize(few);
        benchmark::DoNotOptimize(many);
        found = few.valid | many.valid;
      }
      benchmark::DoNotOptimize(gap);
      missing += static_cast<unsigned>(std::popcount(~detail::bits_of(found) & 0xFU));
    }
    return static_cast<int>(missing);
  }

 private:
  struct Group {
    detail::FeatureLanes features;
    detail::FaceLanes faces_a, faces_b;
    detail::Lanes tilt{};
    std::array<Pose, detail::lane_count> X_WA, X_WB;
  };
  [[nodiscard]] bool are_boxes(int i) const {
    const Pair& pair = world_.pairs()[static_cast<std::size_t>(i)];
    const auto is_box = [&](PartId part) {
      return world_.part(part).shape.level(0).core.kind() == Convex::Kind::box;
    };
    return is_box(pair.a) && is_box(pair.b);
  }

  const World& world_;
  std::vector<Group> groups_;
};

void near_pair(benchmark::State& state) {
  const Scene& scene = scenes[state.range(0)];
  const auto pairs = static_cast<std::size_t>(state.range(1));
  if (!is_right(scene, static_cast<int>(pairs))) {
    return state.SkipWithError("the forces are not those of the queries");
  }
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
  FullLanes lanes(setting);
  (void)lanes.evaluate(scene.are_parallel);  // finds the faces
  if (10 * lanes.evaluate(scene.are_parallel) > lanes.pairs()) {
    return state.SkipWithError("a tenth of the lanes has no answer");
  }
  std::vector<double> raw_ns, tick_ns, least_ns;
  double near = 0.0, overlapping = 0.0;
  std::size_t tick = 0;
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
    const double raw = ns_since(start);
    const auto middle = Clock::now();
    benchmark::DoNotOptimize(lanes.evaluate(scene.are_parallel));
    const double least = ns_since(middle);
    world.motion().tick = static_cast<std::int64_t>(tick);
    world.place(setting.tool, setting.X_WT[at], {});
    const auto begin = Clock::now();
    const PairForces& forces = coprocessor.exchange();
    const double whole = ns_since(begin);
    state.SetIterationTime(1e-9 * whole);
    near += forces.totals.near;
    raw_ns.push_back(raw / static_cast<double>(pairs));
    tick_ns.push_back(whole / std::max(1, forces.totals.near));
    least_ns.push_back(least / std::max(1, lanes.pairs()));
  }
  const double all = static_cast<double>(tick);
  state.counters["near"] = near / all;
  state.counters["overlapping"] = overlapping / all;
  state.counters["raw_ns"] = median(raw_ns);
  state.counters["tick_ns"] = median(tick_ns);
  state.counters["least_ns"] = median(least_ns);
  state.counters["ratio"] = median(tick_ns) / median(raw_ns);
  state.SetLabel(scene.name);
}

#ifdef REPEL_BENCH_MUJOCO

using bench::MuJoCoContacts;

/// How many pairs have no contact, or a nearest one that is off by more than 1e-6 m, at all
/// positions.
int wrong_contacts(const Setting& setting, MuJoCoContacts& contacts) {
  int wrong = 0;
  for (const Pose& X_WT : setting.X_WT) {
    contacts.place(X_WT);
    contacts.find();
    const std::vector<double> nearest = contacts.nearest();
    for (std::size_t i = 0; i < nearest.size(); ++i) {
      const Pair& pair = setting.world.pairs()[i];
      const Part& A = setting.world.part(pair.a);
      const Part& B = setting.world.part(pair.b);
      const Separation s = separation(A.shape, X_WT * A.X_BP, B.shape, B.X_BP);
      if (!(nearest[i] >= s.lower - 1e-6 && nearest[i] <= s.upper + 1e-6)) ++wrong;
    }
  }
  return wrong;
}

/// The contacts of the same pairs at the same poses, as MuJoCo finds them: with `multiccd` more
/// than one of a pair with a hull.
void mujoco_contacts(benchmark::State& state) {
  const Scene& scene = scenes[state.range(0)];
  const auto pairs = static_cast<int>(state.range(1));
  const Setting setting(scene, pairs);
  MuJoCoContacts contacts(setting.solids, range, state.range(2) != 0);
  state.counters["wrong"] = wrong_contacts(setting, contacts);
  state.counters["checked"] = static_cast<double>(positions) * pairs;
  std::vector<double> tick_ns;
  double found = 0.0;
  for (auto _ : state) {
    contacts.place(setting.X_WT[tick_ns.size() % positions]);
    const auto begin = Clock::now();
    found += contacts.find();
    const double whole = ns_since(begin);
    state.SetIterationTime(1e-9 * whole);
    tick_ns.push_back(whole / pairs);
  }
  state.counters["contacts"] = found / static_cast<double>(tick_ns.size()) / pairs;
  state.counters["tick_ns"] = median(tick_ns);
  state.SetLabel(scene.name);
}

#endif

}  // namespace

BENCHMARK(near_pair)
    ->ArgNames({"scene", "pairs"})
    ->ArgsProduct({{0, 1, 2, 3, 4, 5}, {16, 100, 300}})
    ->UseManualTime();
#ifdef REPEL_BENCH_MUJOCO
// Where faces meet, else one contact is all.
BENCHMARK(mujoco_contacts)
    ->ArgNames({"scene", "pairs", "multiccd"})
    ->ArgsProduct({{1, 3, 5}, {16, 100, 300}, {0, 1}})
    ->UseManualTime();
#endif

int main(int argc, char** argv) {
  return repel::bench::run_benchmarks(argc, argv,
                                      "near_pairs: a near pair in a tick against its warm query.");
}
