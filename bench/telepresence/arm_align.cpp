// SPDX-License-Identifier: BSD-3-Clause
// A tilted tool is pressed against a plate and into a corner: the wall forces alone align it.

#include <algorithm>
#include <cmath>
#include <string_view>

#include "arm_chatter.hpp"
#include "arm_run.hpp"
#include "part.hpp"

namespace repel::telepresence {

namespace {

struct Alignment {
  const char* name;
  const char* tool;
  const char* obstacles;
  const char* start;  // a tilted tool
  const char* push;   // [mm/s]
  int axes;           // determined by the plates: z, or all
  bool relieved;      // RELIEF allows the tool to turn
};

/// Largest angle [deg] between an axis of the tool and the nearest axis of the plates.
double tilt_of(const Pose& X_WT, int axes) {
  double worst = 1.0;
  for (int i = 3 - axes; i < 3; ++i)
    worst = std::min(worst, X_WT.linear().col(i).cwiseAbs().maxCoeff());
  return std::acos(std::min(1.0, worst)) * 180.0 / M_PI;
}

constexpr const char* cube = "{name: cube, shape: box, size: 80 80 80 mm, position: 0 0 -10 mm}";
// As in scenes/plates.yaml.
constexpr const char* flat_plate = "{name: plate, shape: box, size: 100 120 20 mm}";

constexpr const char* floor_plate =
    "{name: floor, shape: box, size: 0.8 0.8 0.05 m, position: 0.6 -0.15 0.375 m, law: wall}";
constexpr const char* edge_plates =
    "{name: floor, shape: box, size: 0.8 0.8 0.05 m, position: 0.6 -0.15 0.375 m, law: wall}, "
    "{name: side, shape: box, size: 0.6 0.05 0.3 m, position: 0.6 -0.04 0.5 m, law: wall}";
constexpr const char* corner_plates =
    "{name: floor, shape: box, size: 0.8 0.8 0.05 m, position: 0.6 -0.15 0.375 m, law: wall}, "
    "{name: side, shape: box, size: 0.6 0.05 0.3 m, position: 0.6 -0.04 0.5 m, law: wall}, "
    "{name: end, shape: box, size: 0.05 0.6 0.3 m, position: 0.715 -0.15 0.5 m, law: wall}";

constexpr const char* leaning = "0 45 -180 4 -40 0 deg";
constexpr const char* twisted = "0 45 -180 4 -40 4 deg";
constexpr Alignment alignments[] = {
    {"plate", cube, floor_plate, leaning, "0 0 -40", 1, false},
    {"plate", cube, floor_plate, leaning, "0 0 -40", 1, true},
    {"edge", cube, edge_plates, twisted, "0 30 -30", 3, false},
    {"edge", cube, edge_plates, twisted, "0 30 -30", 3, true},
    {"corner", cube, corner_plates, twisted, "30 30 -30", 3, false},
    {"corner", cube, corner_plates, twisted, "30 30 -30", 3, true},
    {"plate, as in Figure 8", flat_plate, floor_plate, leaning, "0 0 -40", 1, false},
    {"plate, as in Figure 8", flat_plate, floor_plate, leaning, "0 0 -40", 1, true},
};

std::string network_of(bool relieved) {
  std::string text = ArmScene::free_coupling;
  const std::string relief =
      "{module: relief, compliant: [rx, ry, rz], angular_stiffness: 2 N m/rad, "
      "angular_damping: 1 N m s/rad}, ";
  if (relieved) text.insert(text.find("{module: kbb2"), relief);
  return text;
}

}  // namespace

Result align(const Options& options) {
  Result result{
      .title = "A tilted tool pushed flat",
      .columns = {"into", "RELIEF in rotation", "rate [Hz]", "tilt before [deg]",
                  "tilt after [deg]", "flat after [s]", "mean force [N]", "chatter above 30 Hz [N]",
                  "swing of the tilt [mdeg]"},
      .notes = {"A cube of 80 mm; in Figure 8 a plate of 100 by 120 by 20 mm. Tilt is the "
                "greatest angle between its axes and those of the plates. It counts as "
                "flat from when the tilt stays below a tenth of the initial one. A row fails if "
                "less than four fifths of the tilt is "
                "removed, or the chatter exceeds 2 % of the mean force.",
                ArmChatter::note}};
  append(result.columns, ArmChatter::columns());
  std::size_t done = 0;
  const std::vector<double> rates = options.quick ? std::vector{400.0} : std::vector{400.0, 4000.0};
  for (const Alignment& each : alignments) {
    for (const double rate_hz : rates) {
      ArmScene scene{.tool = each.tool,
                     .obstacles = each.obstacles,
                     .network = network_of(each.relieved),
                     .start = each.start,
                     .rate_hz = rate_hz};
      scene.script = std::string("{name: push, device: spaceball, duration: 6 s, linear: ") +
                     each.push + " mm/s}";
      Trace force{.rate_hz = rate_hz};
      Trace tilt{.rate_hz = rate_hz};
      ArmChatter chatter(rate_hz);
      const ArmEnd end = run_arm(scene, 6.0, [&](const ArmTick& tick) {
        force.samples.push_back(tick.record.virtual_force.force.norm());
        tilt.samples.push_back(tilt_of(tick.X_WT, each.axes));
        chatter.add(tick);
      });
      const double before = tilt.samples.front();
      const auto touched = std::find_if(force.samples.begin(), force.samples.end(),
                                        [](double newton) { return newton > 1.0; });
      const auto not_flat = std::find_if(tilt.samples.rbegin(), tilt.samples.rend(),
                                         [&](double angle) { return angle > 0.1 * before; });
      const double turning = static_cast<double>((tilt.samples.rend() - not_flat) -
                                                 (touched - force.samples.begin())) /
                             rate_hz;
      const std::string row = std::string(each.name) + ", " + to_text(rate_hz) + " Hz";
      result.fail(row, end.complaint);
      if (!(tilt.mean() < 0.2 * before)) result.fail(row, "the tool is not turned flat");
      if (!(force.chatter() < 0.02 * force.mean())) result.fail(row, "it chatters");
      std::vector<Json>& cells = result.rows.emplace_back();
      cells = {each.name,    each.relieved,   rate_hz,           before, tilt.mean(), turning,
               force.mean(), force.chatter(), 1e3 * tilt.swing()};
      append(cells, chatter.row());
      Json& series = result.series[row + (each.relieved ? ", RELIEF" : "")];
      series = {{"joints", chatter.joints()}};
      if (each.tool == std::string_view(flat_plate)) series.update(chatter.curves());
      progress("align", ++done, std::size(alignments) * rates.size());
    }
  }
  return result;
}

}  // namespace repel::telepresence
