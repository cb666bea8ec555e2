/// @file
/// Whether the walls of a world are too stiff for the arm and the rate that render them.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include <Eigen/Eigenvalues>

#include <repel/network/clean_stiffness.hpp>
#include <repel/world/arm.hpp>
#include <repel/world/world.hpp>

namespace repel {

/// The least viscous damping [N s/m] that the joints of an arm put up against motion of its tool,
/// in any direction: 1 / the greatest eigenvalue of J_v D^-1 J_v'. 0 when a joint that can move the
/// tool has none. Not for the tick.
/// @param J 6 x n, linear rows first, at the tool
[[nodiscard]] inline double device_damping(const ArmModel& model,
                                           const Eigen::Matrix<double, 6, Eigen::Dynamic>& J) {
  Mat3 mobility = Mat3::Zero();  // [m/(N s)]
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    const Vec3 column = J.col(static_cast<Eigen::Index>(i)).head<3>();
    const double damping = model.links[i].viscous_friction;
    if (column.isZero(1e-12)) continue;
    if (!(damping > 0.0)) return 0.0;
    mobility += column * column.transpose() / damping;
  }
  const double greatest = Eigen::SelfAdjointEigenSolver<Mat3>(mobility).eigenvalues()(2);
  return greatest > 0.0 ? 1.0 / greatest : 0.0;
}

/// Checks every law of the world against the clean-stiffness limit for `period` [s] and
/// `damping` [N s/m] of the device. One sentence with the numbers for each pair of bodies that a
/// wall is too stiff for, each different law once; empty when all is well. Not for the tick.
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
