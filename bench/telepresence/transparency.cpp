// SPDX-License-Identifier: BSD-3-Clause
// Transparency: the hand excites the lever with a sine, in free motion or while pressing on the
// wall; the displayed impedance is the ratio of effort and flow at the port of the lever.

#include <cmath>
#include <complex>

#include "part.hpp"
#include "rig.hpp"

namespace repel::telepresence {

namespace {

using Complex = std::complex<double>;

constexpr double push = 20.0;          // [N] force of the hand on the wall
constexpr double sine = 5.0;           // [N] amplitude of the sine, if the lever were held still
constexpr double rate_hz = 2000.0;     // tick rate
constexpr double stiffness = 50000.0;  // [N/m] of the wall
constexpr double damping = 5.0;        // [N s/m] of the wall

struct Setting {
  Way way = Way::direct;
  double delay_ms = 0.0;
  bool contact = false;
  [[nodiscard]] std::string name() const {
    const std::string where = contact ? "wall, " : "free, ";
    return where + (way == Way::direct ? "direct" : "waves " + to_text(delay_ms) + " ms");
  }
};

struct Felt {
  Complex impedance;  // [N s/m]
  std::string complaint;
};

/// Impedance of the slider and its environment alone [N s/m].
Complex truth(const Setting& setting, double hz) {
  const Complex s(0.0, 2.0 * M_PI * hz);
  const SliderOptions slider;
  const Complex free = slider.mass * s + slider.friction;
  return setting.contact ? free + damping + stiffness / s : free;
}

/// The first `settling` seconds, in which the hand approaches the wall, are not evaluated.
Felt feel(const Setting& setting, double hz, double settling) {
  RigOptions options{.rate_hz = rate_hz, .way = setting.way};
  options.channel.delay = 1e-3 * setting.delay_ms;
  options.wall = stiff_wall(stiffness, damping);
  options.wall_at = setting.contact ? 0.0 : 1e3;
  Rig rig(options);
  const double periods = std::max(2.0, std::ceil(hz));
  const auto counted = static_cast<std::int64_t>(std::llround(periods * rate_hz / hz));
  const auto settled = static_cast<std::int64_t>(std::llround(settling * rate_hz));
  const double omega = 2.0 * M_PI * periods / (static_cast<double>(counted) * rig.period());
  const double leading =
      sine / std::hypot(RigOptions::hand_damping, RigOptions::hand_stiffness / omega);
  const double approach = setting.contact ? push / RigOptions::hand_stiffness : 0.0;  // in 1 s
  bool lost = false;
  Complex effort;
  Complex flow;
  for (std::int64_t i = -settled; i < counted; ++i) {
    const double phase = omega * static_cast<double>(i) * rig.period();
    const bool first_second = i < -settled + std::llround(rate_hz);
    const Sample now = rig.tick(leading * std::cos(phase) + (first_second ? approach : 0.0));
    if (i < 0) continue;
    lost = lost || (setting.contact && now.wall <= 0.0);
    effort += now.felt * std::polar(1.0, -phase);
    flow += now.lever_speed * std::polar(1.0, -phase);
  }
  return {effort / flow, lost ? "the wall was left" : rig.complaint()};
}

std::vector<Setting> settings() {
  std::vector<Setting> all;
  for (const bool contact : {false, true}) {
    all.push_back({.contact = contact});
    for (const double ms : {0.0, 10.0, 50.0, 100.0}) all.push_back({Way::waves, ms, contact});
  }
  return all;
}

double decibels(double ratio) {
  return 20.0 * std::log10(ratio);
}

}  // namespace

Result transparency(const Options& options) {
  Result result{.title = "Transparency: the impedance the operator feels"};
  result.columns = {"contact and way"};
  result.notes = {
      "2 kHz; the true impedance is that of the slider alone, in contact with a wall of 50 kN/m "
      "and 5 N s/m."};
  const std::vector<double> shown{0.5, 2.0, 10.0, 30.0};  // [Hz] rows of the table
  for (const double hz : shown) {
    const std::string at = " at " + to_text(hz) + " Hz ";
    result.columns.insert(result.columns.end(), {"felt" + at + "[N s/m]", "phase" + at + "[deg]",
                                                 "against the truth" + at + "[dB]"});
  }
  std::vector<double> all = shown;
  for (int i = 0; i < (options.quick ? 0 : 60); ++i) {
    all.push_back(0.2 * std::pow(10.0, 0.04 * i));  // up to 46 Hz
  }
  std::size_t done = 0;
  for (const Setting& setting : settings()) {
    std::vector<Json> row{setting.name()};
    Json& curve = result.series[setting.name()];
    for (const double hz : all) {
      const Felt felt = feel(setting, hz, options.quick ? 3.0 : 8.0);
      const double size = std::abs(felt.impedance);
      const double degrees = std::arg(felt.impedance) * 180.0 / M_PI;
      const double against = decibels(size / std::abs(truth(setting, hz)));
      result.fail(setting.name() + " at " + to_text(hz) + " Hz", felt.complaint);
      if (row.size() < result.columns.size()) row.insert(row.end(), {size, degrees, against});
      curve.push_back({{"frequency [Hz]", hz},
                       {"felt [N s/m]", size},
                       {"phase [deg]", degrees},
                       {"against the truth [dB]", against}});
    }
    result.rows.push_back(row);
    progress("transparency", ++done, settings().size());
  }
  return result;
}

}  // namespace repel::telepresence
