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

bool SpeedBounds::bound(LeastConstraint& problem, std::span<const double> v,
                        const ArmInertia::Vector& walls, const ToolSpeed& tool) noexcept {
  friction_ = driven_ - problem.asked_acceleration();
  const ArmInertia::Vector a = problem.acceleration() + friction_;
  bool has_more = false;
  for (std::size_t i = 0; i < v.size(); ++i) {
    const double limit = model_.links[i].velocity_limit;
    if (!is_beyond(v[i], a.coeff(index(i)), rounding * limit)) continue;
    const double side = v[i] + horizon_ * a.coeff(index(i)) > 0.0 ? -1.0 : 1.0;
    ArmInertia::Vector h = ArmInertia::Vector::Zero(a.size());
    h.coeffRef(index(i)) = side;
    const bool is_slow = std::abs(v[i]) < 0.5 * limit;
    if (add(problem, h, side * v[i], limit, is_slow ? &walls : nullptr, status::speed_limit)) {
      has_more = true;
    }
  }
  return bound_tool(problem, v, a, walls, tool) || has_more;
}

bool SpeedBounds::bound_tool(LeastConstraint& problem, std::span<const double> v,
                             const ArmInertia::Vector& acceleration,
                             const ArmInertia::Vector& walls, const ToolSpeed& tool) noexcept {
  if (tool.jacobian == nullptr) return false;
  const double limit = (1.0 + tool_slack) * tool.limit;
  Vec3 now;
  const Vec3 fast = then(tool, v, acceleration, now);
  const double speed = std::sqrt(squared_norm(fast));
  if (!(speed > rounding * limit)) return false;
  const Vec3 n = fast / speed;
  const double* const J = tool.jacobian->data();
  ArmInertia::Vector h = ArmInertia::Vector::Zero(acceleration.size());
  for (std::size_t i = 0; i < v.size(); ++i) {
    h.coeffRef(index(i)) = -(n.x() * J[6 * i] + n.y() * J[6 * i + 1] + n.z() * J[6 * i + 2]);
  }
  const bool let_walls = tool.is_carried || dot(n, now) < 0.5 * limit;
  return add(problem, h, -dot(n, now), limit, let_walls ? &walls : nullptr, status::tool_speed);
}

Status SpeedBounds::said(const LeastConstraint& problem) noexcept {
  Status found = 0;
  for (const LeastConstraint::Row& row : problem.rows()) {
    if (row.force > 0.0) found |= row.tag;
  }
  return found;
}

bool SpeedBounds::add(LeastConstraint& problem, const ArmInertia::Vector& h, double rate,
                      double limit, const ArmInertia::Vector* walls, Status tag) const noexcept {
  LeastConstraint::Row* row = problem.add(h, rate);
  if (row == nullptr) return false;
  row->give = LeastConstraint::soft;
  row->tag = tag;
  row->least_rate = rate - problem.step() * (limit + rate) / horizon_;
  double by_walls = 0.0;
  for (Eigen::Index i = 0; i < h.size(); ++i) {
    row->rate += problem.step() * h.coeff(i) * friction_.coeff(i);
    if (walls != nullptr) by_walls += problem.step() * row->moved.coeff(i) * walls->coeff(i);
  }
  if (walls != nullptr) row->least_rate = std::min(row->least_rate, row->rate + by_walls);
  return true;
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
