/// @file
/// Checks whether walls and joint limits are too stiff for the tick rate.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <repel/loop/arm_bodies.hpp>
#include <repel/network/machinery/clean_stiffness.hpp>
#include <repel/network/modules/limits.hpp>
#include <repel/world/arm.hpp>
#include <repel/world/world.hpp>

namespace repel {

namespace detail {

/// The greatest eigenvalue of a symmetric matrix, in closed form (Smith, Communications of the ACM
/// 4(4), 1961): Eigen's solver costs every source that includes a cell half a second to compile.
[[nodiscard]] inline double greatest_eigenvalue(const double (&A)[3][3]) noexcept {
  const double mean = (A[0][0] + A[1][1] + A[2][2]) / 3.0;
  const double off = A[0][1] * A[0][1] + A[0][2] * A[0][2] + A[1][2] * A[1][2];
  const double x = A[0][0] - mean, y = A[1][1] - mean, z = A[2][2] - mean;
  const double spread = std::sqrt((x * x + y * y + z * z + 2.0 * off) / 6.0);
  if (!(spread > 0.0)) return mean;
  const double determinant = x * (y * z - A[1][2] * A[1][2]) -
                             A[0][1] * (A[0][1] * z - A[1][2] * A[0][2]) +
                             A[0][2] * (A[0][1] * A[1][2] - y * A[0][2]);
  const double cosine = std::clamp(0.5 * determinant / (spread * spread * spread), -1.0, 1.0);
  return mean + 2.0 * spread * std::cos(std::acos(cosine) / 3.0);
}

}  // namespace detail

/// The least viscous damping [N s/m] of the joints of an arm against motion of its tool, over all
/// directions: 1 / the greatest eigenvalue of J_v D^-1 J_v'. 0 when a joint that can move the tool
/// has none. Not for the tick.
/// @param J 6 x n, linear rows first, at the tool
[[nodiscard]] inline double device_damping(const ArmModel& model, const Jacobian& J) noexcept {
  double mobility[3][3] = {};  // [m/(N s)]
  for (std::size_t joint = 0; joint < model.links.size(); ++joint) {
    const Vec3 column = column_of(J, static_cast<Eigen::Index>(joint)).linear;
    const double damping = model.links[joint].viscous_friction;
    if (!(largest_entry(column) > 1e-12)) continue;
    if (!(damping > 0.0)) return 0.0;
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) mobility[i][k] += column.coeff(i) * column.coeff(k) / damping;
    }
  }
  const double greatest = detail::greatest_eigenvalue(mobility);
  return greatest > 0.0 ? 1.0 / greatest : 0.0;
}

/// The largest stiffness [N/m] or [N m/rad] of a sampled spring with a damping of its own [N s/m]
/// or [N m s/rad] that cannot make an arm oscillate, whatever the mass behind it: B / ((0.5 + 2 d)
/// T). The damping is solved together with the mass of the arm (network/machinery/prediction.hpp)
/// and may be as large as one likes; the spring acts by the position measured, half a tick late on
/// average and d ticks more. @param period [s] @param drive_delay d [ticks]
[[nodiscard]] constexpr double stable_stiffness(double damping, double period,
                                                double drive_delay) noexcept {
  return damping / ((0.5 + 2.0 * drive_delay) * period);
}

/// What is being checked: the spring of a wall or a limit.
struct SampledSpring {
  const char* what;        ///< "wall" or "joint limit"
  const char* unit;        ///< of the stiffness; the damping has the same times s
  double stiffness = 0.0;  ///< [N/m] or [N m/rad]
  double damping = 0.0;    ///< [N s/m] or [N m s/rad]
};

/// Empty when the spring is stable; else one sentence with all numbers and what would do.
[[nodiscard]] inline std::string complaint(const SampledSpring& at, double period,
                                           double drive_delay) {
  const double most = stable_stiffness(at.damping, period, drive_delay);
  if (at.stiffness <= most) return {};
  const auto text = [](double value) { return repel::to_text(value, 4); };
  const std::string unit = at.unit;
  const std::string damping_unit =
      unit.substr(0, unit.find('/')) + " s" + unit.substr(unit.find('/'));
  const double ticks = 0.5 + 2.0 * drive_delay;
  std::string said = std::string(at.what) + " stiffness is " + text(at.stiffness) + ' ' + unit +
                     "; with its damping of " + text(at.damping) + ' ' + damping_unit +
                     " the limit is " + text(most) + ' ' + unit + " at a period of " +
                     text(1e3 * period) + " ms and a drive delay of " + text(drive_delay) +
                     " ticks; this " + at.what + " needs " + text(at.stiffness * ticks * period) +
                     ' ' + damping_unit + " of damping";
  if (at.damping > 0.0) {
    said += ", or a rate of at least " + text(at.stiffness * ticks / at.damping) + " Hz";
  }
  return said;
}

/// Checks every law of the world for a tick of `period` [s] and arms whose drives are late by
/// `drive_delay` [ticks]. Walls that `device_damping` [N s/m] alone makes passive pass as well
/// (network/machinery/clean_stiffness.hpp). Returns one sentence with the numbers for each pair of
/// bodies whose wall is too stiff, equal sentences once; empty when there is none. Not for the
/// tick.
/// @throws SetupError with the first of them when `check` is `error`
inline std::vector<std::string> check_gains(const World& world, double period, double drive_delay,
                                            double device_damping, network::GainCheck check) {
  std::vector<std::string> complaints;
  std::vector<std::string> told;
  for (const Pair& pair : world.pairs()) {
    std::string text =
        complaint({"wall", "N/m", pair.law.stiffness(), pair.law.damping}, period, drive_delay);
    const network::CleanStiffness clean{.period = period,
                                        .device_damping = device_damping,
                                        .wall_damping = pair.law.damping,
                                        .delay = drive_delay * period};
    if (pair.law.stiffness() <= clean.limit()) continue;
    if (!text.empty()) {
      text += ", or " + repel::to_text(clean.needed_damping(pair.law.stiffness()), 4) +
              " N s/m of damping in the device, which has " + repel::to_text(device_damping, 4);
    }
    if (text.empty() || std::find(told.begin(), told.end(), text) != told.end()) continue;
    told.push_back(text);
    if (pair.law.given_at == GivenAt::tool) text += "; these are its numbers at the part";
    complaints.push_back("'" + world.part(pair.b).name + "': " + text);
    if (check == network::GainCheck::error) throw SetupError(complaints.back());
  }
  return complaints;
}

/// The same for the limits of the joints.
inline std::string check_gains(const network::Limits& limits, double period, double drive_delay,
                               network::GainCheck check) {
  const network::JointLimits& law = limits.law();
  std::string text =
      complaint({"joint limit", "N m/rad", law.stiffness, law.damping}, period, drive_delay);
  if (check == network::GainCheck::error && !text.empty()) throw SetupError(text);
  return text;
}

}  // namespace repel
