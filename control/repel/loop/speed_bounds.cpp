// SPDX-License-Identifier: BSD-3-Clause
#include <repel/loop/speed_bounds.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

namespace repel {

bool SpeedBounds::foresee(const network::dense::Factored& mass, std::span<const double> asked,
                          std::span<const double> weight, std::span<const double> v,
                          const ToolSpeed& tool) noexcept {
  for (std::size_t i = 0; i < v.size(); ++i) {
    const double net = asked[i] - weight[i];
    const double dry = std::min(model_.links[i].coulomb_friction, std::abs(net));
    // What brakes is not counted on.
    driven_.coeffRef(index(i)) = v[i] * net < 0.0 ? net : net - std::copysign(dry, net);
  }
  mass.solve(driven_);
  for (std::size_t i = 0; i < v.size(); ++i) {
    if (is_beyond(v[i], driven_.coeff(index(i)), model_.links[i].velocity_limit)) return true;
  }
  if (tool.jacobian == nullptr) return false;
  Vec3 now;
  const double limit = (1.0 + tool_slack) * tool.limit;
  return squared_norm(then(tool, v, driven_, now)) > limit * limit;
}

void SpeedBounds::bound_joints(LeastConstraint& problem, std::span<const double> v,
                               const ArmInertia::Vector& walls) noexcept {
  joints_ = problem.rows().size();
  friction_ = driven_ - problem.asked_acceleration();
  for (std::size_t i = 0; i < v.size(); ++i) {
    const double limit = model_.links[i].velocity_limit;
    const double a = driven_.coeff(index(i));
    if (!is_beyond(v[i], a, limit)) continue;
    const double side = v[i] + horizon_ * a > 0.0 ? -1.0 : 1.0;
    ArmInertia::Vector h = ArmInertia::Vector::Zero(driven_.size());
    h.coeffRef(index(i)) = side;
    LeastConstraint::Row* row = add(problem, h, side * v[i], limit);
    if (row == nullptr) break;
    if (std::abs(v[i]) < 0.5 * limit) let_walls(problem, *row, walls);
  }
  tool_ = problem.rows().size();
}

bool SpeedBounds::bound_tool(LeastConstraint& problem, std::span<const double> v,
                             const ArmInertia::Vector& walls, const ToolSpeed& tool) noexcept {
  if (tool.jacobian == nullptr) return false;
  const double limit = (1.0 + tool_slack) * tool.limit;
  Vec3 now;
  const Vec3 fast = then(tool, v, problem.acceleration() + friction_, now);
  const double speed = std::sqrt(squared_norm(fast));
  if (!(speed > (1.0 + 1e-2) * limit)) return false;
  const Vec3 n = fast / speed;
  const double* const J = tool.jacobian->data();
  ArmInertia::Vector h = ArmInertia::Vector::Zero(driven_.size());
  for (std::size_t i = 0; i < v.size(); ++i) {
    h.coeffRef(index(i)) = -(n.x() * J[6 * i] + n.y() * J[6 * i + 1] + n.z() * J[6 * i + 2]);
  }
  LeastConstraint::Row* row = add(problem, h, -dot(n, now), limit);
  if (row == nullptr) return false;
  if (tool.is_carried || dot(n, now) < 0.5 * limit) let_walls(problem, *row, walls);
  return true;
}

Status SpeedBounds::said(const LeastConstraint& problem) const noexcept {
  Status found = 0;
  for (std::size_t k = joints_; k < problem.rows().size(); ++k) {
    if (!(problem.rows()[k].force > 0.0)) continue;
    found |= k < tool_ ? status::speed_limit : status::tool_speed;
  }
  return found;
}

LeastConstraint::Row* SpeedBounds::add(LeastConstraint& problem, const ArmInertia::Vector& h,
                                       double rate, double limit) const noexcept {
  LeastConstraint::Row* row = problem.add(h, rate);
  if (row == nullptr) return nullptr;
  row->give = LeastConstraint::soft;
  row->least_rate = rate - problem.step() * (limit + rate) / horizon_;
  for (Eigen::Index i = 0; i < h.size(); ++i) {
    row->rate += problem.step() * h.coeff(i) * friction_.coeff(i);
  }
  return row;
}

void SpeedBounds::let_walls(const LeastConstraint& problem, LeastConstraint::Row& row,
                            const ArmInertia::Vector& walls) noexcept {
  double then = row.rate;
  for (Eigen::Index i = 0; i < walls.size(); ++i) {
    then += problem.step() * row.moved.coeff(i) * walls.coeff(i);
  }
  row.least_rate = std::min(row.least_rate, then);
}

Vec3 SpeedBounds::then(const ToolSpeed& tool, std::span<const double> v,
                       const ArmInertia::Vector& acceleration, Vec3& now) const noexcept {
  const double* const J = tool.jacobian->data();  // columns of six, linear rows first
  now = Vec3(0, 0, 0);
  Vec3 gained(0, 0, 0);
  for (std::size_t i = 0; i < v.size(); ++i) {
    const Vec3 column(J[6 * i], J[6 * i + 1], J[6 * i + 2]);
    now += v[i] * column;
    gained += acceleration.coeff(index(i)) * column;
  }
  return now + horizon_ * gained;
}

}  // namespace repel
