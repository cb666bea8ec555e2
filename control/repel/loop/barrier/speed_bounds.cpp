// SPDX-License-Identifier: BSD-3-Clause
#include <repel/loop/barrier/speed_bounds.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

namespace repel {

double braked_within(double distance, double deceleration, double reaction) noexcept {
  if (!(distance > 0.0)) return 0.0;
  const double late = deceleration * reaction;
  const double square = 2.0 * deceleration * distance;
  return square / (late + std::sqrt(late * late + square) + 1e-300);
}

SpeedBounds::SpeedBounds(const ArmModel& model, double horizon) : model_(model), horizon_(horizon) {
  driven_.setZero(static_cast<Eigen::Index>(model.links.size()));
  friction_ = down_ = up_ = driven_;
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    const double most = model.links[i].velocity_limit;
    const double limit = most > 0.0 ? most : std::numeric_limits<double>::infinity();
    const double effort = effort_bound(model, i) / mass_uncertainty;
    ends_.push_back({limit, effort, 2.0 * horizon_ * limit, 0.5 * limit * limit / effort});
  }
}

void SpeedBounds::observe(std::span<const double> q, const ArmInertia& inertia) noexcept {
  for (Eigen::Index i = 0; i < up_.size(); ++i) {
    const auto joint = static_cast<std::size_t>(i);
    const ArmLink& link = model_.links[joint];
    const End& end = ends_[joint];
    down_.coeffRef(i) = up_.coeffRef(i) = end.limit;
    if (q.empty() || !(link.lower < link.upper)) continue;
    const double mass = inertia.matrix().coeff(i, i);
    const double far = end.late + end.braking * mass;  // [rad] where it may be as fast as anywhere
    const double below = q[joint] - link.lower;
    const double above = link.upper - q[joint];
    const auto within = [&](double distance) {
      return std::min(end.limit, braked_within(distance, end.effort / mass, 2.0 * horizon_));
    };
    if (below < far) down_.coeffRef(i) = within(below);
    if (above < far) up_.coeffRef(i) = within(above);
  }
}

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
    if (excess(index(i), v[i], driven_.coeff(index(i))) != 0.0) return true;
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
    const double beyond = excess(index(i), v[i], a.coeff(index(i)));
    const double limit = beyond > 0.0 ? up_.coeff(index(i)) : down_.coeff(index(i));
    if (std::abs(beyond) <= (rounding - 1.0) * limit + of_joints) continue;
    const double side = beyond > 0.0 ? -1.0 : 1.0;
    ArmInertia::Vector h = ArmInertia::Vector::Zero(a.size());
    h.coeffRef(index(i)) = side;
    const double most = model_.links[i].velocity_limit;
    const bool is_at_end = !(limit >= most) || !(most > 0.0);
    const bool is_slow = std::abs(v[i]) < 0.5 * most;
    if (add(problem, h, side * v[i], limit, is_slow ? &walls : nullptr,
            is_at_end ? status::joint_limit : status::speed_limit)) {
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
  double by_all = 0.0;
  for (Eigen::Index i = 0; i < h.size(); ++i) {
    row->rate += problem.step() * h.coeff(i) * friction_.coeff(i);
    by_all += problem.step() * h.coeff(i) * problem.asked_acceleration().coeff(i);
    if (walls != nullptr) by_walls += problem.step() * row->moved.coeff(i) * walls->coeff(i);
  }
  // Walls that the operator withstands do not move it.
  const double pushed_out = std::max(by_walls, by_all);
  if (walls != nullptr) row->least_rate = std::min(row->least_rate, row->rate + pushed_out);
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
