// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/modules/relief.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include <repel/base/setup_error.hpp>

namespace repel::network {

Relief::Relief(const ReliefOptions& options) : options_(checked_fields(options)) {
  for (std::size_t i = 0; i < options.compliant.size(); ++i) {
    if (!options.compliant[i] || may_give(options, i)) continue;
    throw SetupError("a compliant direction has neither stiffness nor damping");
  }
}

bool Relief::may_give(const ReliefOptions& options, std::size_t i) noexcept {
  return i < 3 ? options.stiffness != 0.0 || options.damping > 0.0
               : options.angular_stiffness != 0.0 || options.angular_damping > 0.0;
}

void Relief::suit(const RobotEnd& robot) noexcept {
  options_.damping = suited({options_.stiffness, options_.damping}, robot.mass, robot.response,
                            {0.0, ReliefOptions{}.damping})
                         .damping;
  options_.angular_damping =
      suited({options_.angular_stiffness, options_.angular_damping}, robot.inertia, robot.response,
             {0.0, ReliefOptions{}.angular_damping})
          .damping;
}

void Relief::prepare(double period) {
  step_ = std::min(1.0, detail::checked_period(period) / switching_time);
  frame_ = options_.frame;
  is_settled_ = false;
  for (int i = 0; i < 6; ++i) {
    const bool angular = i >= 3;
    const double k = angular ? options_.angular_stiffness : options_.stiffness;
    const double b = angular ? options_.angular_damping : options_.damping;
    spring_resistance_[i] = 0.5 * k * period;
    const double resistance = spring_resistance_[i] + b;
    full_conductance_[i] = resistance > 0.0 ? 1.0 / resistance : 0.0;
    conductance_[i] = options_.compliant[i] ? full_conductance_[i] : 0.0;
    inverse_stiffness_[i] = k > 0.0 ? 1.0 / k : 0.0;
  }
}

void Relief::read(const Signals& signals) noexcept {
  switch_over(signals.hand.compliant);
  turn_ = frame_ == ReliefFrame::tool ? rotation(signals.X_WT) : Mat3(Mat3::Identity());
  if (signals.at_rest) wave_.setZero();
}

bool Relief::reflected(const Equivalent<any_size>& behind,
                       Equivalent<any_size>& shown) const noexcept {
  Mat<any_size> G = Mat<any_size>::Zero(6, 6);
  for (int block = 0; block < 6; block += 3) {
    if (is_rigid(block)) continue;
    for (int row = 0; row < 3; ++row) {
      const Vec3 left = times_gains(row, block);
      for (int column = 0; column < 3; ++column) {
        const double* t = turn_.data() + column;
        G.coeffRef(block + row, block + column) =
            left[0] * t[0] + (left[1] * t[3] + left[2] * t[6]);
      }
    }
  }
  shown = behind;
  shown.add_admittance(G, -in_world(product(conductance_, wave_)));
  return true;
}

void Relief::incident(const PortState<any_size>& at_root, const Equivalent<any_size>& /*behind*/,
                      PortState<any_size>& at_leaf) noexcept {
  const Six effort = in_task(at_root.effort);
  const Six relative = product(conductance_, effort - wave_);
  wave_ += 2.0 * product(spring_resistance_, relative);
  most_ = most_.cwiseMax(product(wave_, inverse_stiffness_).cwiseAbs());
  at_leaf.effort = at_root.effort;
  at_leaf.flow = at_root.flow - in_world(relative);
}

double Relief::stored() const noexcept {
  return 0.5 * product(wave_, wave_).dot(inverse_stiffness_);
}

void Relief::switch_over(std::int32_t wanted) noexcept {
  if (wanted == wanted_ && is_settled_) return;
  wanted_ = wanted;
  is_settled_ = true;
  const ReliefFrame frame = wanted < 0                  ? options_.frame
                            : (wanted & world_bit) != 0 ? ReliefFrame::world
                                                        : ReliefFrame::tool;
  const bool turns = frame != frame_;
  bool is_rigid = true;
  for (int i = 0; i < 6; ++i) {
    const bool is_wanted =
        wanted < 0 ? options_.compliant[static_cast<std::size_t>(i)] : ((wanted >> i) & 1) != 0;
    const double target = is_wanted && !turns ? full_conductance_[i] : 0.0;
    const double step = step_ * full_conductance_[i];
    conductance_[i] = std::clamp(target, conductance_[i] - step, conductance_[i] + step);
    if (conductance_[i] < 1e-9 * step) conductance_[i] = 0.0;
    is_settled_ = is_settled_ && !turns && conductance_[i] == target;
    if (conductance_[i] > 0.0) is_rigid = false;
    if (conductance_[i] > 0.0 || wave_[i] == 0.0) continue;
    forgotten_ += 0.5 * wave_[i] * wave_[i] * inverse_stiffness_[i];
    wave_[i] = 0.0;
  }
  if (is_rigid) frame_ = frame;
}

Relief::Six Relief::in_task(const Vec<any_size>& world) const noexcept {
  Six task;
  for (int i = 0; i < 6; ++i) {
    const double* t = &turn_(0, i % 3);
    const Vec3 v = three(world, i - i % 3);
    task[i] = t[0] * v[0] + t[1] * v[1] + t[2] * v[2];
  }
  return task;
}

Vec<any_size> Relief::in_world(const Six& task) const noexcept {
  return to_vec(turn_ * three(task, 0), turn_ * three(task, 3));
}

bool Relief::is_rigid(int block) const noexcept {
  const double* g = conductance_.data() + block;
  return g[0] == 0.0 && g[1] == 0.0 && g[2] == 0.0;
}

Vec3 Relief::times_gains(int row, int block) const noexcept {
  const double* t = turn_.data() + row;
  return {t[0] * conductance_[block], t[3] * conductance_[block + 1],
          t[6] * conductance_[block + 2]};
}

}  // namespace repel::network
