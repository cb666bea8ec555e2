// SPDX-License-Identifier: BSD-3-Clause
// The arm is driven into a table at various angles and presses on it.

#include <cmath>

#include "arm_chatter.hpp"
#include "arm_run.hpp"
#include "part.hpp"
#include "spectrum.hpp"

namespace repel::telepresence {

namespace {

constexpr double speed = 0.06;  // [m/s] of the operator's command

struct Contact {
  double peak = 0.0;  // [N]
  int losses = 0;     // number of contact losses after first contact
  Trace force{};      // [N] along the normal
  Trace height{};     // [m]
  Trace along{};      // [m] along the table
  ArmChatter chatter;
  ArmEnd end{};
};

Contact lean(double angle_deg, double rate_hz, double seconds) {
  const double angle = angle_deg / 180.0 * M_PI;
  ArmScene scene{
      .tool = "{name: rod, shape: capsule, radius: 15 mm, length: 60 mm, position: 0 0 -30 mm}",
      .obstacles =
          "{name: table, shape: box, size: 0.8 0.8 0.05 m, position: 0.5 -0.15 0.40 m, "
          "law: wall}",
      .rate_hz = rate_hz};
  scene.script = "{name: lean, device: spaceball, duration: " + to_text(seconds) +
                 " s, linear: " + to_text(-speed * std::sin(angle)) + " 0 " +
                 to_text(-speed * std::cos(angle)) + " m/s}";
  Contact contact{.chatter = ArmChatter(rate_hz)};
  for (Trace* trace : {&contact.force, &contact.height, &contact.along}) trace->rate_hz = rate_hz;
  bool touched = false;
  contact.end = run_arm(scene, seconds, [&](const ArmTick& tick) {
    const double force = tick.record.virtual_force.force.z();
    contact.losses += touched && force <= 0.0 ? 1 : 0;
    touched = force > 0.0;
    contact.peak = std::max(contact.peak, force);
    contact.force.samples.push_back(force);
    contact.height.samples.push_back(tick.X_WT.translation().z());
    contact.along.samples.push_back(tick.X_WT.translation().x());
    contact.chatter.add(tick);
  });
  return contact;
}

}  // namespace

Result contact(const Options& options) {
  Result result{.title = "The arm driven into a table",
                .columns = {"rate [Hz]", "angle to the normal [deg]", "greatest force [N]",
                            "mean force [N]", "chatter above 30 Hz [N]", "swing of the height [um]",
                            "slides [mm/s]", "contact lost"},
                .notes = {"The operator commands 60 mm/s all the time; KBB2 saturates at 120 N. "
                          "Figures are of the last second. A row fails if contact is lost, or the "
                          "chatter exceeds 1 % of the mean force.",
                          ArmChatter::note}};
  append(result.columns, ArmChatter::columns());
  result.fail("rms_above", check_rms_above());
  const std::vector<double> rates =
      options.quick ? std::vector{400.0} : std::vector{400.0, 1000.0, 4000.0};
  const std::vector<double> angles =
      options.quick ? std::vector{0.0, 60.0} : std::vector{0.0, 15.0, 30.0, 45.0, 60.0, 75.0};
  std::size_t done = 0;
  for (const double rate_hz : rates) {
    for (const double angle : angles) {
      const Contact c = lean(angle, rate_hz, options.quick ? 4.0 : 8.0);
      const std::string row = to_text(rate_hz) + " Hz, " + to_text(angle) + " deg";
      result.fail(row, c.end.complaint);
      if (c.losses > 0) result.fail(row, "the tool lost contact");
      if (!(c.force.chatter() < 0.01 * c.force.mean())) result.fail(row, "it chatters");
      std::vector<Json>& cells = result.rows.emplace_back();
      cells = {rate_hz,
               angle,
               c.peak,
               c.force.mean(),
               c.force.chatter(),
               1e6 * c.height.swing(),
               1e3 * std::abs(c.along.drift()),
               c.losses};
      append(cells, c.chatter.row());
      result.series[row] = {{"joints", c.chatter.joints()}};
      progress("contact", ++done, rates.size() * angles.size());
    }
  }
  return result;
}

}  // namespace repel::telepresence
