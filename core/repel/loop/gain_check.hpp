/// @file
/// Checks whether the walls of a world are too stiff for the arm and the tick rate.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <repel/loop/arm_bodies.hpp>
#include <repel/network/machinery/clean_stiffness.hpp>
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

/// Checks every law of the world against the clean-stiffness limit for `period` [s] and `damping`
/// [N s/m] of the device. Returns one sentence with the numbers for each pair of bodies whose wall
/// is too stiff, equal sentences once; empty when there is none. Not for the tick.
/// @throws SetupError with the first of them when `check` is `error`
inline std::vector<std::string> check_gains(const World& world, double period, double damping,
                                            network::GainCheck check) {
  std::vector<std::string> complaints;
  std::vector<std::string> told;
  for (const Pair& pair : world.pairs()) {
    const network::CleanStiffness at{
        .period = period, .device_damping = damping, .wall_damping = pair.law.damping};
    const std::string text = network::complaint(at, pair.law.stiffness());
    if (text.empty() || std::find(told.begin(), told.end(), text) != told.end()) continue;
    told.push_back(text);
    complaints.push_back("'" + world.part(pair.b).name + "': " + text);
    if (check == network::GainCheck::error) throw SetupError(complaints.back());
  }
  return complaints;
}

}  // namespace repel
