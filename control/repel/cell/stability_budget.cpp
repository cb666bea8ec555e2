// SPDX-License-Identifier: BSD-3-Clause
#include <repel/cell/stability_budget.hpp>

#include <algorithm>

#include <repel/cell/layout.hpp>
#include <repel/loop/arms/arm_bodies.hpp>
#include <repel/loop/arms/arm_inertia.hpp>
#include <repel/loop/gain_check.hpp>
#include <repel/network/elements/dense.hpp>
#include <repel/network/modules/guide.hpp>
#include <repel/network/modules/kbb2.hpp>
#include <repel/network/modules/limits.hpp>

namespace repel {
namespace {

/// [1/kg], [1/(kg m^2)] Greatest mobility of the tool and of each joint.
struct Mobility {
  double linear = 0.0, angular = 0.0;
  std::vector<double> joints;
};

Mobility mobility_of(const ArmDescription& arm) {
  const auto n = static_cast<Eigen::Index>(arm.model.links.size());
  Jacobian J(6, n);
  arm.kinematics->tool_jacobian(J);
  ArmInertia inertia(arm.model);
  (void)inertia.update(*arm.kinematics);  // the cell has checked it
  network::dense::Factored mass;
  (void)mass.factor(n, [&](Eigen::Index i) { return inertia.matrix().data()[i]; });
  Mobility mobility;
  double linear[3][3] = {}, angular[3][3] = {};
  for (Eigen::Index k = 0; k < n; ++k) {
    ArmInertia::Vector unit = ArmInertia::Vector::Unit(n, k);
    mass.solve(unit);
    mobility.joints.push_back(unit.coeff(k));
    const Twist moved = column_of(J, k);
    for (Eigen::Index i = 0; i < n; ++i) {
      const Twist other = column_of(J, i);
      for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c) {
          linear[r][c] += moved.linear.coeff(r) * unit.coeff(i) * other.linear.coeff(c);
          angular[r][c] += moved.angular.coeff(r) * unit.coeff(i) * other.angular.coeff(c);
        }
      }
    }
  }
  mobility.linear = detail::greatest_eigenvalue(linear);
  mobility.angular = detail::greatest_eigenvalue(angular);
  return mobility;
}

}  // namespace

std::vector<StabilityShare> stability_budget(const Cell& cell, std::size_t arm) {
  const ArmDescription& description = cell.description().arms[arm];
  const double T = 1.0 / cell.description().rate_hz;
  const double ticks = wall_ticks(description.options.drive_delay);
  const Mobility mobility = mobility_of(description);
  std::vector<StabilityShare> shares;
  const auto add = [&](std::string source, double K, double B, double mobile) {
    const double needed = B > 0.0 ? ticks * K * T / B : 0.0;
    shares.push_back({std::move(source), K * T * T * mobile, B * T * mobile, needed});
  };
  const ForceLaw* stiffest = nullptr;
  double turning = 0.0;  // [N m/rad]
  for (const Pair& pair : cell.world().pairs()) {
    const Part& a = cell.world().part(pair.a);
    const Part& b = cell.world().part(pair.b);
    const BodyId tool = cell.layout(arm).tool;
    if (a.body != tool && b.body != tool) continue;
    if (stiffest == nullptr || pair.law.stiffness() > stiffest->stiffness()) stiffest = &pair.law;
    if (!(pair.law.tilt > 0.0)) continue;
    const double width = std::min(a.shape.reach(), b.shape.reach());
    turning = std::max(turning, pair.law.surface_force * width / pair.law.tilt);
  }
  if (stiffest != nullptr) {
    add("walls", stiffest->stiffness(), stiffest->damping, mobility.linear);
    add("walls, turning", turning, 0.0, mobility.angular);
  }
  const network::Network& network = cell.network(arm);
  if (const auto* coupling = network.find<network::Kbb2>()) {
    const network::Kbb2Options& gains = coupling->options();
    add("coupling", gains.stiffness, gains.damping, mobility.linear);
    add("coupling, turning", gains.angular_stiffness, gains.angular_damping, mobility.angular);
  }
  if (const auto* guide = network.find<network::Guide>()) {
    for (const network::Guide::Held& held : guide->fixtures()) {
      add("fixture " + held.options.name, held.along.stiffness(), held.damping, mobility.linear);
    }
  }
  if (const auto* limits = network.find<network::Limits>()) {
    for (int i = 0; i < limits->size(); ++i) {
      const auto joint = static_cast<std::size_t>(i);
      add("limits of " + description.model.links[joint].joint_name, limits->law(i).stiffness,
          limits->law(i).damping, mobility.joints[joint]);
    }
  }
  return shares;
}

}  // namespace repel
