// SPDX-License-Identifier: BSD-3-Clause
// The hand presses on a hard wall without moving; the remaining motion is the limit cycle.

#include <algorithm>
#include <cmath>

#include <repel/network/machinery/clean_stiffness.hpp>

#include "part.hpp"
#include "rig.hpp"
#include "spectrum.hpp"

namespace repel::telepresence {

namespace {

constexpr double push = 20.0;     // [N]
constexpr double damping = 5.0;   // [N s/m] of the wall
constexpr double audible = 30.0;  // [Hz] a force above this frequency is chatter

struct Chatter {
  double rms = 0.0;   // [N] above `audible`
  double jump = 0.0;  // [N] largest from tick to tick
};

struct Held {
  double swing_um = 0.0;  // of the slider, peak to peak
  double force = 0.0;     // [N] mean
  Chatter wall, drive, lever;
  std::string complaint;
};

Chatter chatter_of(const std::vector<Sample>& samples, double Sample::*force, double rate_hz) {
  std::vector<double> forces;
  forces.reserve(samples.size());
  for (const Sample& sample : samples) forces.push_back(sample.*force);
  return {rms_above(forces, rate_hz, audible), largest_jump(forces)};
}

/// Statistics of the last second of `seconds`.
Held held(const RigOptions& options, double seconds) {
  Rig rig(options);
  const auto ticks = std::llround(seconds * options.rate_hz);
  const auto second = std::llround(options.rate_hz);
  std::vector<Sample> samples;
  const double way =
      options.wall_at + push / RigOptions::hand_stiffness;  // [m] in the first second
  for (std::int64_t i = 0; i < ticks; ++i) {
    const Sample now = rig.tick(i < second ? way : 0.0);
    if (i < ticks - second) continue;
    samples.push_back(now);
  }
  const auto [low, high] =
      std::minmax_element(samples.begin(), samples.end(),
                          [](const Sample& a, const Sample& b) { return a.slider < b.slider; });
  double sum = 0.0;
  for (const Sample& sample : samples) sum += sample.wall;
  const auto chatter = [&](double Sample::*force) {
    return chatter_of(samples, force, options.rate_hz);
  };
  return {1e6 * (high->slider - low->slider),
          sum / static_cast<double>(samples.size()),
          chatter(&Sample::wall),
          chatter(&Sample::drive),
          chatter(&Sample::felt),
          rig.complaint()};
}

}  // namespace

Result hold(const Options& options) {
  Result result{
      .title = "Holding a hard wall",
      .columns = {"rate [Hz]", "way", "wall [kN/m]", "encoder [um]", "mean force [N]",
                  "swing of the slider [um]", "chatter above 30 Hz [N]", "jump of the force [N]",
                  "joint chatter above 30 Hz [N]", "jump of the joint force [N]",
                  "lever chatter above 30 Hz [N m]", "jump of the lever torque [N m]"},
      .notes = {"Walls of 5 N s/m, at the clean limit and at four times it; waves over 50 ms. The "
                "joint is that of the slider, which moves in a line: it takes a force."}};
  result.fail("rms_above", check_rms_above());
  std::size_t done = 0;
  for (const double rate_hz : {400.0, 1000.0, 4000.0}) {
    for (const bool at_limit : {true, false}) {
      for (const double resolution : {0.0, 10e-6}) {
        for (const Way way : {Way::direct, Way::waves}) {
          RigOptions rig{.rate_hz = rate_hz, .way = way};
          const network::CleanStiffness clean{.period = 1.0 / rate_hz,
                                              .device_damping = rig.slider.friction,
                                              .wall_damping = damping};
          const double stiffness = at_limit ? clean.limit() : 4.0 * clean.limit();
          rig.channel = {.delay = 0.05, .seed = options.seed};
          rig.wall = stiff_wall(stiffness, damping);
          rig.resolution = resolution;
          const Held h = held(rig, options.quick ? 4.0 : 10.0);
          result.fail(to_text(rate_hz) + " Hz, " + name_of(way), h.complaint);
          result.rows.push_back({rate_hz, name_of(way), 1e-3 * stiffness, 1e6 * resolution, h.force,
                                 h.swing_um, h.wall.rms, h.wall.jump, h.drive.rms, h.drive.jump,
                                 h.lever.rms, h.lever.jump});
          progress("hold", ++done, 24);
        }
      }
    }
  }
  return result;
}

}  // namespace repel::telepresence
