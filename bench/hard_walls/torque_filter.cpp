// SPDX-License-Identifier: BSD-3-Clause
#include "torque_filter.hpp"

#include <cstddef>

#include <repel/cell/layout.hpp>
#include <repel/loop/arms/arm_inertia.hpp>

namespace repel::hard_walls {
namespace {

constexpr double kept = 2e-3;     // d_s [m] that is kept of each gap
constexpr double begins = 0.05;   // d_i [m]
constexpr double approach = 0.5;  // xi [m/s] at d_i
constexpr double decay = 10.0;    // a1, a2 [1/s]

}  // namespace

double step_of(Way way, double period) {
  return way == Way::damper_of_arm ? period : 1.0;
}

void add_bound(Way way, const BarrierRow& row, LeastConstraint& problem) {
  if (way == Way::damper_of_arm) {
    if (row.gap > begins - kept) return;
    if (LeastConstraint::Row* bound = problem.add(row.h, row.rate)) {
      bound->least_rate = -approach * row.gap / (begins - kept);
    }
  } else if (LeastConstraint::Row* bound = problem.add(row.h, row.bending)) {
    bound->least_rate = -2.0 * decay * row.rate - decay * decay * row.gap;
  }
}

TorqueFilter::TorqueFilter(Way way, Cell& cell, std::size_t arm)
    : way_(way),
      cell_(cell),
      tool_(cell.layout(arm).tool),
      model_(cell.description().arms[arm].model),
      kinematics_(model_),
      dynamics_(model_),
      links_(cell.layout(arm).links, kinematics_.links()),
      rows_(model_, kept),
      problem_(model_.links.size(), BarrierRows::most),
      jacobian_(6, kinematics_.links()),
      mass_(kinematics_.links(), kinematics_.links()),
      upper_(effort_bounds(model_)),
      bias_(upper_.size()),
      untold_(upper_.size()) {
  for (const double most : upper_) lower_.push_back(-most);
}

void TorqueFilter::filter(std::span<const HardContact> gaps, const ArmReadings& readings,
                          std::span<double> torques) {
  kinematics_.update(readings.q);
  kinematics_.tool_jacobian(jacobian_);
  (void)links_.place(cell_.world(), kinematics_, readings.v);
  rows_.gather(gaps, tool_, jacobian_, links_, readings.q, readings.v, untold_, 0.1);
  dynamics_.inertia(readings.q, mass_);
  dynamics_.bias(readings.q, readings.v, bias_);
  for (std::size_t i = 0; i < bias_.size(); ++i) {
    bias_[i] += model_.links[i].viscous_friction * readings.v[i];
  }
  const double period = 1e-9 * static_cast<double>(cell_.period().count());
  const auto entry = [this](Eigen::Index i) { return mass_.data()[i]; };
  if (!problem_.begin(mass_.rows(), entry, step_of(way_, period))) return;
  problem_.ask(torques, bias_);
  for (const BarrierRow& row : rows_.all()) {
    if (row.top_speed == 0.0) add_bound(way_, row, problem_);
  }
  if (!problem_.solve(lower_, upper_)) return;
  for (std::size_t i = 0; i < torques.size(); ++i) torques[i] = problem_.torque(i);
}

}  // namespace repel::hard_walls
