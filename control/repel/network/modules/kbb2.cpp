// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/modules/kbb2.hpp>

#include <repel/base/setup_error.hpp>

namespace repel::network {

Kbb2::Kbb2(const Kbb2Options& options) : options_(checked_fields(options)) {}

void Kbb2::suit(const RobotEnd& robot) noexcept {
  constexpr Kbb2Options usual;
  constexpr double turning = 1.0;  // [rad/s]
  Kbb2Options& o = options_;
  const Gains linear = suited({o.stiffness, o.damping}, robot.mass, robot.response,
                              {usual.stiffness, usual.damping}, o.force_limit / robot.speed);
  const Gains angular =
      suited({o.angular_stiffness, o.angular_damping}, robot.inertia, robot.response,
             {usual.angular_stiffness, usual.angular_damping}, o.torque_limit / turning);
  o.stiffness = linear.stiffness;
  o.damping = linear.damping;
  o.angular_stiffness = angular.stiffness;
  o.angular_damping = angular.damping;
}

void Kbb2::fit(Space space, int size) {
  const bool tool = space == Space::tool;
  rotations_ = tool ? 3 : 0;
  const auto fill = [&](Vec<any_size>& gain, double linear, double angular) {
    gain.setConstant(size, linear);
    for (Eigen::Index i = tool ? size - 3 : size; i < size; ++i) gain.coeffRef(i) = angular;
  };
  fill(stiffness_, options_.stiffness, options_.angular_stiffness);
  fill(damping_, options_.damping, options_.angular_damping);
  fill(shunt_, options_.shunt, options_.angular_shunt);
  wave_.setZero(size);
}

void Kbb2::prepare(double period) {
  spring_resistance_ = 0.5 * detail::checked_period(period) * stiffness_;
  conductance_ = inverse(spring_resistance_ + damping_);
  has_shunt_ = !shunt_.isZero(0.0);
  none_.setZero(shunt_.size());
}

void Kbb2::read(const Signals& signals) noexcept {
  if (signals.at_rest) wave_.setZero();
}

bool Kbb2::reflected(const Equivalent<any_size>& behind,
                     Equivalent<any_size>& shown) const noexcept {
  shown = behind;
  if (root_ == Side::right) add_shunt(shown);
  shown.add_diagonal_admittance(conductance_, -product(conductance_, wave_));
  if (!has_shunt_ || root_ == Side::right) return true;
  if (!shown.take_form(Form::impedance)) return false;
  add_shunt(shown);
  return true;
}

void Kbb2::incident(const PortState<any_size>& at_root, const Equivalent<any_size>& /*behind*/,
                    PortState<any_size>& at_leaf) noexcept {
  at_leaf = at_root;
  if (root_ == Side::left) at_leaf.effort -= product(shunt_, at_leaf.flow);
  effort_ = at_leaf.effort;
  for (Eigen::Index i = 0; i < wave_.size(); ++i) {
    const double relative = conductance_.coeff(i) * (effort_.coeff(i) - wave_.coeff(i));
    at_leaf.flow.coeffRef(i) -= relative;
    wave_.coeffRef(i) += 2.0 * (spring_resistance_.coeff(i) * relative);
  }
  if (root_ == Side::right) at_leaf.effort -= product(shunt_, at_leaf.flow);
  limit();
}

double Kbb2::stored() const noexcept {
  return 0.5 * product(wave_, wave_).dot(inverse(stiffness_));
}

Vec<any_size> Kbb2::inverse(Vec<any_size> diagonal) noexcept {
  for (double& x : diagonal) x = 1.0 / x;
  return diagonal;
}

void Kbb2::scale(Eigen::Index first, Eigen::Index count, double share) noexcept {
  for (Eigen::Index i = first; i < first + count; ++i) wave_.coeffRef(i) *= share;
}

void Kbb2::add_shunt(Equivalent<any_size>& shown) const noexcept {
  if (has_shunt_) shown.add_impedance(shunt_.asDiagonal(), none_);
}

void Kbb2::limit() noexcept {
  const Eigen::Index linear = wave_.size() - rotations_;
  const double force = wave_.head(linear).norm();
  saturated_ = force > options_.force_limit;
  if (saturated_) scale(0, linear, options_.force_limit / force);
  if (rotations_ == 0) return;
  const double torque = three(wave_, linear).norm();
  if (!(torque > options_.torque_limit)) return;
  saturated_ = true;
  scale(linear, 3, options_.torque_limit / torque);
}

}  // namespace repel::network
