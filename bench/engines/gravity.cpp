// SPDX-License-Identifier: BSD-3-Clause
// The torques that hold a PUMA still, for each engine, compared with the gravity constants that
// Armstrong, Khatib and Burdick published (ICRA 1986).

#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <random>

#include "../distance/markdown.hpp"
#include "arms.hpp"
#include "part.hpp"

namespace repel::engines {

namespace {

constexpr int links = 6;
constexpr double moment =
    1e-4;  // [s] of free fall from rest: too short for the joint angles to change much
using Torques = Eigen::Matrix<double, links, 1>;
using Constants = Eigen::Matrix<double, 5, 1>;

const Constants published = (Constants() << -37.2, -8.44, 1.02, 0.249, -0.0282).finished();
/// One unit in the last published digit [N m]: the constants were computed from rounded numbers.
const Constants last_digit = (Constants() << 0.1, 0.01, 0.01, 0.001, 0.0001).finished();

/// The factor of each constant in the torque of each joint.
Eigen::Matrix<double, links, 5> formula(std::span<const double> q) {
  const double s2 = std::sin(q[1]), c2 = std::cos(q[1]);
  const double s23 = std::sin(q[1] + q[2]), c23 = std::cos(q[1] + q[2]);
  const double s4 = std::sin(q[3]), c4 = std::cos(q[3]);
  const double s5 = std::sin(q[4]), c5 = std::cos(q[4]);
  Eigen::Matrix<double, links, 5> out;
  out << 0, 0, 0, 0, 0,                            //
      c2, s23, s2, c23, s23 * c5 + c23 * c4 * s5,  //
      0, s23, 0, c23, s23 * c5 + c23 * c4 * s5,    //
      0, 0, 0, 0, -s23 * s4 * s5,                  //
      0, 0, 0, 0, c23 * s5 + s23 * c4 * c5,        //
      0, 0, 0, 0, 0;
  return out;
}

/// Joint accelerations [rad/s^2] of `arm` from rest under `torques`.
Torques acceleration(SimulatedArm& arm, std::span<const double> q, const Torques& torques) {
  arm.reset(q, {});
  arm.set_torques({torques.data(), links});
  arm.step(moment);
  const std::vector<double> v = arm.velocities();
  return Eigen::Map<const Torques>(v.data()) / moment;
}

/// The torques that hold the arm still, identified from its response to zero torque and to 1 N m at
/// each joint: the inertia need not be known.
Torques holding_torques(SimulatedArm& arm, std::span<const double> q) {
  const Torques free = acceleration(arm, q, Torques::Zero());
  Eigen::Matrix<double, links, links> answer;
  for (int i = 0; i < links; ++i) {
    answer.col(i) = acceleration(arm, q, Torques::Unit(i)) - free;
  }
  return -answer.partialPivLu().solve(free);
}

std::vector<std::vector<double>> random_poses(std::size_t count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> angle(-M_PI, M_PI);
  std::vector<std::vector<double>> poses(count, std::vector<double>(links));
  for (std::vector<double>& q : poses) {
    for (double& joint : q) joint = angle(random);
  }
  return poses;
}

struct Held {
  Constants constants;      // best fit to the torques [N m]
  double from_kdl = 0.0;    // largest deviation of a torque from KDL's [N m]
  double from_paper = 0.0;  // and from the published formula [N m]
};

Held hold(const Engine& engine, const std::vector<std::vector<double>>& poses) {
  const ArmModel model = armstrong_puma();
  const std::unique_ptr<SimulatedArm> arm = engine.make(model, 1);
  Dynamics dynamics(model);
  const std::vector<double> at_rest(links, 0.0);
  Held held;
  const auto rows = static_cast<Eigen::Index>(links * poses.size());
  Eigen::MatrixXd factors(rows, 5);
  Eigen::VectorXd torques(rows);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Torques measured = holding_torques(*arm, poses[i]);
    Torques kdl;
    dynamics.bias(poses[i], at_rest, {kdl.data(), links});
    const auto at = static_cast<Eigen::Index>(links * i);
    factors.middleRows<links>(at) = formula(poses[i]);
    torques.segment<links>(at) = measured;
    held.from_kdl = std::max(held.from_kdl, (measured - kdl).lpNorm<Eigen::Infinity>());
  }
  held.constants = factors.colPivHouseholderQr().solve(torques);
  held.from_paper = (factors * published - torques).lpNorm<Eigen::Infinity>();
  return held;
}

}  // namespace

Result gravity(const Options& options) {
  const auto poses = random_poses(options.quick ? 20 : 1000, options.seed);
  Result result{.title = "Torques that hold a PUMA 560",
                .columns = {"engine", "g1 [N m]", "g2 [N m]", "g3 [N m]", "g4 [N m]", "g5 [N m]",
                            "furthest from the published [N m]", "from KDL [N m]"},
                .notes = {bench::text(
                    "Armstrong's set at %zu random poses, no friction. The torques are computed "
                    "from an engine's accelerations; the constants are their best fit.",
                    poses.size())}};
  const auto add = [&](const std::string& name, const Constants& g, const Json& from_paper,
                       const Json& from_kdl) {
    result.rows.push_back({name, g[0], g[1], g[2], g[3], g[4], from_paper, from_kdl});
  };
  add("published", published, "", "");
  for (const Engine& engine : engines()) {
    const Held held = hold(engine, poses);
    add(engine.name, held.constants, held.from_paper, held.from_kdl);
    const bool same = ((held.constants - published).array().abs() <= last_digit.array()).all();
    if (!same) result.fail(engine.name, "its constants are not the published ones");
    if (!(held.from_kdl < 1e-3)) result.fail(engine.name, "it is held by other torques than KDL's");
  }
  return result;
}

}  // namespace repel::engines
