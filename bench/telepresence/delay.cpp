// SPDX-License-Identifier: BSD-3-Clause
// Over a delayed line, a hand drives the slider into a hard wall, three strokes, and then holds it
// there.

#include <algorithm>
#include <array>
#include <cmath>

#include "part.hpp"
#include "rig.hpp"

namespace repel::telepresence {

namespace {

constexpr double strokes_hz = 1.25;
constexpr double reach = 0.10;     // [m] amplitude of the hand, 50 mm beyond the wall
constexpr double hold_from = 2.8;  // [s] end of the fourth stroke
constexpr double swing_limit =
    10.0;  // [mm] limit for the swing of the lever in the last second of a stable run

/// Velocity of the hand [m/s].
double hand_speed(double time) {
  const double omega = 2.0 * M_PI * strokes_hz;
  return time < hold_from ? 0.5 * reach * omega * std::sin(omega * time) : 0.0;
}

struct Run {
  std::vector<Sample> samples;
  double tracking_mm = 0.0,
         tracking_n = 0.0;  // RMS error relative to the other end, delayed by the line
  double made = 0.0;        // [J] energy generated
  double swing_mm = 0.0;    // of the lever in the last second
  double jump = 0.0;        // [N] largest change of the hand force per tick, last three seconds
  std::string complaint;

  [[nodiscard]] double peak(double Sample::*force) const {
    double most = 0.0;
    for (const Sample& s : samples) most = std::max(most, std::abs(s.*force));
    return most;
  }
  [[nodiscard]] bool stable() const { return swing_mm < swing_limit; }
};

Run run(const RigOptions& options, double seconds) {
  Rig rig(options);
  Run run;
  const auto ticks = static_cast<std::size_t>(std::llround(seconds * options.rate_hz));
  const auto late = static_cast<std::size_t>(std::llround(rig.transit() * options.rate_hz));
  double square_m = 0.0;
  double square_n = 0.0;
  for (std::size_t i = 0; i < ticks; ++i) {
    run.samples.push_back(rig.tick(hand_speed(static_cast<double>(i) * rig.period())));
    if (i < late) continue;
    const Sample& then = run.samples[i - late];
    const Sample& now = run.samples.back();
    square_m += std::pow(now.slider - then.lever, 2);
    square_n += std::pow(now.felt - then.wall, 2);
  }
  const auto compared = static_cast<double>(ticks - late);
  run.tracking_mm = 1e3 * std::sqrt(square_m / compared);
  run.tracking_n = std::sqrt(square_n / compared);
  const auto second = static_cast<std::size_t>(std::llround(options.rate_hz));
  const auto by_position = [](const Sample& a, const Sample& b) { return a.lever < b.lever; };
  const auto [low, high] =
      std::minmax_element(run.samples.end() - second, run.samples.end(), by_position);
  run.swing_mm = 1e3 * (high->lever - low->lever);
  for (std::size_t i = ticks - 3 * second; i < ticks; ++i) {
    run.jump = std::max(run.jump, std::abs(run.samples[i].felt - run.samples[i - 1].felt));
  }
  run.made = std::max(0.0, -rig.least_of_line());
  run.complaint = rig.complaint();
  return run;
}

/// The force curves for the plot: the maximum of every 5 ms.
Json curve(const Run& run, double rate_hz) {
  const auto stride = static_cast<std::size_t>(std::llround(0.005 * rate_hz));
  Json times = Json::array();
  Json wall = Json::array();
  Json hand = Json::array();
  for (std::size_t i = 0; i + stride <= run.samples.size(); i += stride) {
    const auto greatest = [&](double Sample::*force) {
      const auto first = run.samples.begin() + static_cast<std::ptrdiff_t>(i);
      const auto smaller = [&](const Sample& a, const Sample& b) {
        return std::abs(a.*force) < std::abs(b.*force);
      };
      const auto last = first + static_cast<std::ptrdiff_t>(stride);
      return *std::max_element(first, last, smaller).*force;
    };
    times.push_back(static_cast<double>(i) / rate_hz);
    wall.push_back(greatest(&Sample::wall));
    hand.push_back(greatest(&Sample::felt));
  }
  return {{"time [s]", times}, {"wall force [N]", wall}, {"force at the hand [N]", hand}};
}

struct DelayCase {
  Way way;
  double jitter_ms, loss;  // [ms], [%]
  double buffer_ms = -1.0;
};
constexpr std::array<DelayCase, 9> delay_cases{{{Way::waves, 0, 0},
                                                {Way::plain, 0, 0},
                                                {Way::waves, 10, 0},
                                                {Way::plain, 10, 0},
                                                {Way::waves, 0, 5},
                                                {Way::waves, 0, 5, 10},
                                                {Way::plain, 0, 5},
                                                {Way::waves, 10, 5},
                                                {Way::plain, 10, 5}}};

void add_row(Result& result, const DelayCase& c, double ms, const Options& options) {
  RigOptions rig{.way = c.way, .buffer = c.buffer_ms < 0.0 ? -1.0 : 1e-3 * c.buffer_ms};
  rig.channel = {.delay = 1e-3 * ms,
                 .jitter = 1e-3 * c.jitter_ms,
                 .loss = 1e-2 * c.loss,
                 .seed = options.seed};
  const Run r = run(rig, options.quick ? 6.0 : 10.0);
  const std::string name = std::string(name_of(c.way)) + ", " + to_text(ms) + " ms, jitter " +
                           to_text(c.jitter_ms) + " ms, loss " + to_text(c.loss) + " %";
  result.fail(name, r.complaint);
  if (c.way == Way::waves && !r.stable()) result.fail(name, "waves are not stable");
  result.rows.push_back({name_of(c.way), ms, c.jitter_ms, c.loss, 1e3 * Rig(rig).buffer(),
                         r.peak(&Sample::wall), r.peak(&Sample::felt), r.tracking_mm, r.tracking_n,
                         r.made, r.swing_mm, r.jump, r.stable()});
  if (ms == 100.0 && c.jitter_ms == 0.0 && c.loss == 5.0 && c.buffer_ms < 0.0) {
    result.series[name_of(c.way)] = curve(r, rig.rate_hz);
  }
}

}  // namespace

Result delay(const Options& options) {
  Result result{
      .title = "Delay: a hard wall over a line",
      .columns = {"line", "delay [ms]", "jitter [ms]", "loss [%]", "buffer [ms]",
                  "peak wall force [N]", "peak force at the hand [N]", "tracking [mm]",
                  "tracking [N]", "energy made [J]", "last swing [mm]", "last jump [N]", "stable"},
      .notes = {"1 kHz; a wall of 50 kN/m and 5 N s/m, which is the clean limit of the slider."}};
  const std::vector<double> delays_ms =
      options.quick ? std::vector<double>{0, 100} : std::vector<double>{0, 10, 25, 50, 100, 200};
  std::size_t done = 0;
  for (const double ms : delays_ms) {
    for (const DelayCase& c : delay_cases) {
      add_row(result, c, ms, options);
      progress("delay", ++done, delay_cases.size() * delays_ms.size());
    }
  }
  return result;
}

}  // namespace repel::telepresence
