// SPDX-License-Identifier: BSD-3-Clause
// How deep hands that push at random get into the walls of the shipped scenes, what holds them off,
// and what it costs.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "../parts.hpp"
#include "libccd_depth.hpp"
#include "random_walls.hpp"
#include "trial.hpp"

namespace {

using namespace repel;
using namespace repel::hard_walls;

using Row = std::vector<bench::Json>;

double rounded(double value, double step) {
  return std::round(value / step) * step;
}
/// Of a length [m].
double millimetres(double length) {
  return rounded(1e3 * length, 1e-3);
}

bench::Json by_libccd(double depth) {
  return has_libccd ? bench::Json(millimetres(depth)) : bench::Json("not built in");
}
constexpr const char* about_libccd =
    "libccd computes the overlaps from the joints of the simulated arm. Its polytope grows until a "
    "step adds less than 1 um: its depth is good to about that, and proves nothing to either side; "
    "a touch may count as none.";

bench::Result ways(const bench::Options& options) {
  bench::Result result;
  result.title = "Ways to hold a tool off, with the same hands, at 400 Hz";
  result.columns = {"scene",
                    "way",
                    "inertia of the arm / model",
                    "deepest, tool [mm]",
                    "deepest, whole arm [mm]",
                    "tools moved [m]",
                    "time of the filter p50 [us]"};
  const std::int64_t ticks = options.quick ? 800 : 32000;
  constexpr std::array scenes{"anderson_4x8", "waste_sorting", "storage_tank", "glove_box"};
  const std::size_t count = options.quick ? 1 : scenes.size();
  constexpr std::array compared{Way::springs,
                                Way::velocity_damper,
                                Way::barrier_function,
                                Way::stopping_distance,
                                Way::damper_of_arm,
                                Way::barrier_of_arm,
                                Way::hard};
  const std::vector<double> inertias =
      options.quick ? std::vector<double>{1.0} : std::vector<double>{1.0, 0.6, 1.6};
  for (std::size_t s = 0; s < count; ++s) {
    for (const double inertia : inertias) {
      for (const Way way : compared) {
        const Outcome outcome = push({.scene = scenes[s],
                                      .way = way,
                                      .inertia = inertia,
                                      .ticks = ticks,
                                      .seed = options.seed});
        const bool is_filter = way != Way::springs && way != Way::hard;
        const double time = outcome.filter.percentile_us(0.5);
        if (way == Way::hard && outcome.deepest > tolerated) {
          result.fail(scenes[s], "a hard wall was entered");
        }
        result.rows.push_back({scenes[s], text_of(way), inertia, millimetres(outcome.tool),
                               millimetres(outcome.deepest), rounded(outcome.way, 0.01),
                               is_filter ? bench::Json(rounded(time, 0.1)) : bench::Json("-")});
        bench::progress("ways", result.rows.size(), compared.size() * count * inertias.size());
      }
    }
  }
  result.notes = {
      "The hand moves at up to 0.6 m/s and 1.8 rad/s along each axis, another way every third of a "
      "second; its coupling gives up to 10 kN. Arms are simulated by Bullet.",
      "All have the springs of the scene. Three published ways change the twist that the hand "
      "commands, by the gaps of the tool: a velocity damper from 50 mm on, a barrier function of "
      "first order with 5 / s, and a scaling of the whole twist to what stops at 2 m/s^2 after 50 "
      "ms. They do not look at links, nor at torques. Two change the torques of the whole arm, so "
      "that its acceleration changes least, by all gaps of tool and links and the ranges of the "
      "joints: a velocity damper of 0.5 m/s at 50 mm (Faverjon and Tournassoud 1987; Kanoun 2011), "
      "and operational space control barrier functions of second order with 10 / s twice (OSCBF; "
      "Morton and Pavone 2025). Each keeps 2 mm.",
      "Assumptions of the two filters of torques: no delay, no slew rate, masses and viscous "
      "friction of the model, no dry friction. The damper also takes the rate of a gap as constant "
      "within a period. Both see the contact points of hard walls and are solved exactly.",
      "Both filter the torques of the cell with springs. That cell has the option `touches`, so it "
      "does not fault joints for being held or moved by the filter. The others have it not: faults "
      "stop them at times, and `tools moved` does not compare.",
      "Times include finding the contact points, not the distance queries."};
  return result;
}

/// Adds a row for each seed. @param prepare completes a setting that has a scene and a rate; false:
/// there is none @param row of what came of it; fails the result by the name of the seed
template <class Prepare, class Row>
void try_at_random(bench::Result& result, const char* part, const bench::Options& options,
                   std::uint64_t count, std::span<const char* const, 4> arms, Prepare prepare,
                   Row row) {
  constexpr double rates[] = {200.0, 400.0, 1000.0, 4000.0};
  for (std::uint64_t i = 0; i < count; ++i) {
    Setting setting;
    setting.seed = options.seed * 1000 + i;
    Draws draws(setting.seed);
    setting.scene = arms[static_cast<std::size_t>(draws.pick(4))];
    setting.rate = rates[draws.pick(4)];
    setting.libccd_every = 1;
    if (!prepare(setting, draws)) continue;
    const std::string name = "seed " + std::to_string(setting.seed);
    result.rows.push_back(row(name, setting, push(setting)));
    bench::progress(part, i + 1, count);
  }
}

bench::Result attacks(const bench::Options& options) {
  bench::Result result;
  result.title = "Random walls, arms and hands";
  result.columns = {"seed",
                    "arm of",
                    "walls",
                    "rate [Hz]",
                    "inertia of the arm / model",
                    "delay of the drive [ticks]",
                    "deepest [mm]",
                    "deepest by libccd [mm]",
                    "told as lost [ticks]",
                    "entered untold",
                    "push withstood [N]"};
  constexpr std::array arms{"anderson_4x8", "plates", "six_axes", "two_arms"};
  const auto prepare = [&](Setting& setting, Draws& draws) {
    setting.inertia = draws.between(0.6, 1.7);
    setting.delay = draws.pick(4);
    setting.ticks = static_cast<std::int64_t>((options.quick ? 2.0 : 8.0) * setting.rate);
    return add_free_walls(setting, draws);
  };
  const auto row = [&](const std::string& name, const Setting& setting, const Outcome& outcome) {
    if (outcome.is_untold()) result.fail(name, "a hard wall was entered without a word");
    return Row{setting.seed,
               setting.scene,
               setting.kind,
               setting.rate,
               rounded(setting.inertia, 0.01),
               setting.delay,
               millimetres(outcome.deepest),
               by_libccd(outcome.by_libccd),
               outcome.lost,
               outcome.is_untold(),
               std::round(outcome.withstood)};
  };
  try_at_random(result, "attacks", options, options.quick ? 4 : 200, arms, prepare, row);
  result.notes = {
      "The springs of the walls give 2 N at the surface. A slot is 1 to 6 mm from the tool on "
      "either side; hulls have 150 corners; crates come from both sides at up to 0.16 m/s and "
      "leave 2 to 20 mm.",
      "A row fails where a wall is entered by more than 0.1 mm, by the proven bound or by libccd "
      "in any tick, and no tick before said that it would be.",
      about_libccd};
  return result;
}

// Light joints, late drives, and a hand beyond the speed limit of the tool.
bench::Result limits(const bench::Options& options) {
  bench::Result result;
  result.title = "Light wrists, late drives and fast hands before soft walls";
  result.columns = {"seed",
                    "arm of",
                    "rate [Hz]",
                    "inertia of the arm / model",
                    "delay of the drive [ticks]",
                    "last link [kg m^2]",
                    "hand [N]",
                    "hand [m/s]",
                    "most gained by sampling [J]",
                    "fastest joint [rad/s]",
                    "chatter of the last joint [N m rms]",
                    "deepest [mm]",
                    "deepest by libccd [mm]",
                    "said"};
  constexpr std::array arms{"anderson_4x8", "plates", "six_axes", "glove_box"};
  const auto prepare = [&](Setting& setting, Draws& draws) {
    setting.way = Way::springs;
    setting.inertia = draws.pick(2) == 0 ? 1.0 : draws.between(0.6, 1.7);
    setting.delay = draws.pick(4);
    setting.wrist = draws.pick(4) == 0 ? 0.0 : 2e-5 * std::pow(50.0, draws.between(0.0, 1.0));
    setting.hand = 60.0;
    setting.hand_speed = draws.between(0.1, 0.6);
    setting.hand_until = options.quick ? 1.0 : 5.0;
    setting.ticks = static_cast<std::int64_t>((setting.hand_until + 2.0) * setting.rate);
    return true;
  };
  const auto row = [&](const std::string& name, const Setting& setting, const Outcome& outcome) {
    if (setting.wrist > 0.0 && outcome.chatter > 0.2)
      result.fail(name, "chattered by more than 0.2 N m");
    if (std::max(outcome.deepest, outcome.by_libccd) > 5e-3)
      result.fail(name, "got more than 5 mm into a wall");
    if ((outcome.said & status::blind) != 0U) result.fail(name, "sound readings were not believed");
    return Row{setting.seed,
               setting.scene,
               setting.rate,
               rounded(setting.inertia, 0.01),
               setting.delay,
               rounded(setting.wrist, 1e-6),
               setting.hand,
               rounded(setting.hand_speed, 0.01),
               rounded(outcome.sampling_energy, 1e-3),
               rounded(outcome.fastest_joint, 0.01),
               rounded(outcome.chatter, 1e-3),
               millimetres(outcome.deepest),
               by_libccd(outcome.by_libccd),
               to_text(outcome.said)};
  };
  try_at_random(result, "limits", options, options.quick ? 2 : 100, arms, prepare, row);
  result.notes = {
      "The walls are those of the scenes, as springs. A link that is light has no friction, and "
      "its joint ends are damped by 20 N m s/rad. The hand moves for 5 s as above, "
      "and then rests.",
      "A row fails where a light joint chatters by more than 0.2 N m, the tool gets deeper than 5 "
      "mm by the proven bound or by libccd, or sound readings are not believed. What sampling "
      "gives to an arm that a hand shakes is shown and not judged: it grows with the square of the "
      "force and the period.",
      about_libccd};
  return result;
}

constexpr std::array<bench::Part, 3> all{
    bench::Part{"ways", "how deep hands get into springs, hard walls and what others do", ways},
    bench::Part{"attacks", "random walls, arms, delays and hands", attacks},
    bench::Part{"limits", "light wrists, late drives and fast hands", limits}};
constexpr bench::Program program{"hard_walls",
                                 "How deep hands that push at random get into walls.",
                                 all,
                                 "the pushes of the hands",
                                 "Everything but the times repeats itself.",
                                 "none"};

}  // namespace

int main(int argc, char** argv) {
  return repel::bench::start<program>(argc, argv);
}
