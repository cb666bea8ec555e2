// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/modules/guide.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <repel/base/setup_error.hpp>

namespace repel::network {

double Guide::Held::stored() const noexcept {
  return gain * along.energy(view.distance) + angular_gain * about.energy(view.angle);
}

Guide::Guide(const GuideOptions& options)
    : ToolSource(with_room(options)),
      ramp_(checked_fields(options).ramp),
      entry_(options.entry_energy) {
  const auto count = static_cast<double>(options.fixtures.size());
  checked("number of fixtures", count, 0, most_fixtures, "");
  for (const FixtureOptions& fixture : options.fixtures) {
    Held& held = held_.emplace_back();
    held.options = fixture;
    held.geometry = FixtureGeometry(fixture);
  }
}

void Guide::prepare(double period) {
  const double least = robot_.wall_ticks * detail::checked_period(period);
  for (Held& held : held_) {
    FixtureOptions& o = held.options;
    const Gains along = settled(o, {o.stiffness, o.damping}, {1000.0, 50.0}, robot_.mass, least);
    const Gains about =
        settled(o, {o.angular_stiffness, o.angular_damping}, {20.0, 0.5}, robot_.inertia, least);
    held.along = Attraction(o.along(along.stiffness), o.has_inside());
    held.about = Attraction(o.about(o.alignment == Alignment::free ? 0.0 : about.stiffness));
    held.damping = along.damping;
    held.angular_damping = about.damping;
  }
  turn_share_ = -std::expm1(-period / turning_time);
}

void Guide::read(const Signals& signals) noexcept {
  const Vec<any_size> flow = signals.tool_flow();
  effort_.setZero(6);
  linear_damping_.setZero();
  angular_damping_.setZero();
  supplied_ = damping_ = 0.0;
  if (signals.released) return release();
  settle_gains(signals);
  for (Held& held : held_) {
    if (held.acts()) push(held, flow);
  }
  keep_passive(signals, flow);
}

double Guide::stored() const noexcept {
  double sum = 0.0;
  for (const Held& held : held_) sum += held.stored();
  return sum;
}

void Guide::add_wall_damping(const Jacobian& jacobian, Mat<any_size>& damping) const noexcept {
  for (Eigen::Index k = 0; k < damping.cols(); ++k) {
    const Twist V{{jacobian.coeff(0, k), jacobian.coeff(1, k), jacobian.coeff(2, k)},
                  {jacobian.coeff(3, k), jacobian.coeff(4, k), jacobian.coeff(5, k)}};
    Vec<any_size> held = to_vec(linear_damping_ * V.linear, angular_damping_ * V.angular);
    for (Eigen::Index row = 0; row < 6; ++row) {
      held.coeffRef(row) += damping_ * controller_.weight()[row] * jacobian.coeff(row, k);
    }
    for (Eigen::Index i = 0; i < damping.rows(); ++i) {
      for (Eigen::Index row = 0; row < 6; ++row) {
        damping.coeffRef(i, k) += jacobian.coeff(row, i) * held.coeff(row);
      }
    }
  }
}

PassivityOptions Guide::with_room(const GuideOptions& options) {
  PassivityOptions passivity = checked_passivity(options.passivity);
  passivity.keeps_energy = true;
  for (const FixtureOptions& fixture : options.fixtures) {
    passivity.most_energy += 2.0 * fixture.most_energy;
  }
  return passivity;
}

Gains Guide::settled(const FixtureOptions& fixture, const Gains& asked, const Gains& usual,
                     double mass, double least) const {
  Gains gains = suited(asked, mass, robot_.response, usual);
  const double needed = least * gains.stiffness;
  if (asked.damping == automatic) gains.damping = std::max(gains.damping, needed);
  if (gains.damping * (1.0 + 1e-9) < needed) {
    throw SetupError("fixture '" + fixture.name + "': its spring of " +
                     repel::to_text(gains.stiffness, 4) + " is too stiff for its damping of " +
                     repel::to_text(gains.damping, 4) + "; allowed: a damping of at least " +
                     to_text_above(needed, 4) + " at this rate and delay, or 'auto'");
  }
  return gains;
}

void Guide::release() noexcept {
  controller_.reset();
  for (Held& held : held_) held.gain = held.angular_gain = 0.0;
  has_position_ = false;
}

double Guide::wanted(const HandInput& hand, const Held& held, std::size_t index) noexcept {
  const bool is_on =
      hand.guides < 0 ? held.options.is_on : ((hand.guides >> static_cast<int>(index)) & 1) != 0;
  const double strength = hand.guide_strength;
  if (!is_on || !(strength >= 0.0)) return is_on ? 1.0 : 0.0;
  return std::min(strength, 1.0);
}

void Guide::settle_gains(const Signals& signals) noexcept {
  const Vec3 x = origin(signals.X_WT);
  const double motion = has_position_ ? norm(Vec3(x - x_)) : 0.0;
  x_ = x;
  has_position_ = true;
  const double step = signals.period / ramp_;
  for (std::size_t i = 0; i < held_.size(); ++i) {
    Held& held = held_[i];
    const double target = signals.at_rest ? 0.0 : wanted(signals.hand, held, i);
    if (!held.acts() && target == 0.0) {
      held.clear = 0.0;
      continue;
    }
    look(held, signals.X_WT, motion);
    held.gain = std::max(std::min(held.gain, target), held.gain - step);
    const double angular_target = held.is_near() ? target : 0.0;
    held.angular_gain =
        std::max(std::min(held.angular_gain, angular_target), held.angular_gain - step);
  }
  entry_.begin(controller_.energy() - stored(), signals.period);
  for (std::size_t i = 0; i < held_.size() && !signals.at_rest; ++i) {
    Held& held = held_[i];
    const double target = wanted(signals.hand, held, i);
    if (!held.acts() && target == 0.0) continue;
    held.gain = entry_.raised(held.gain, target, step, held.along.energy(held.view.distance));
    if (!held.is_near() || held.about.stiffness() == 0.0) continue;
    held.angular_gain =
        entry_.raised(held.angular_gain, target, step, held.about.energy(held.view.angle));
  }
  supplied_ = entry_.spent() / signals.period;
}

void Guide::search(Held& held, const Pose& X_WT) noexcept {
  held.geometry.begin(origin(X_WT));
  held.view = held.geometry.view(X_WT);
  held.clear = held.view.distance;
}

void Guide::look(Held& held, const Pose& X_WT, double motion) noexcept {
  const bool is_new = !held.acts();
  held.clear -= motion;
  const bool may_be_near = held.clear < held.along.border();
  if (is_new && may_be_near) {
    search(held, X_WT);
  } else {
    held.geometry.follow(origin(X_WT), motion);
    held.view = held.geometry.view(X_WT);
    const bool is_free = held.geometry.has_place() && held.angular_gain == 0.0 &&
                         held.view.distance >= held.along.border();
    if (is_free && may_be_near) {
      search(held, X_WT);
      if (held.view.distance < held.along.border()) held.gain = 0.0;
    }
  }
  const double share = is_new ? 1.0 : turn_share_;
  held.across += share * (held.view.across - held.across);
}

void Guide::push(Held& held, const Vec<any_size>& flow) noexcept {
  const FixtureView& view = held.view;
  const double pull = held.gain * held.along.force(view.distance);
  const double turn = held.angular_gain * held.about.force(view.angle);
  Vec3 spring = -pull * view.away_W - turn * view.turned_W;
  const double most = held.options.most_force;
  if (const double size = norm(spring); size > most) spring = spring * (most / size);
  const Mat3 D = held.gain * held.damping * held.along.damping_share(view.distance) * held.across;
  const Mat3 C = held.angular_gain * held.angular_damping * held.about.damping_share(view.angle) *
                 view.turning;
  const double share = share_within(spring, Vec3(-(D * three(flow, 0))), most);
  linear_damping_ += share * D;
  const Vec3 force = spring - share * (D * three(flow, 0));
  const Vec3 torque_spring = -turn * view.axis_W;
  const double angular_share =
      share_within(torque_spring, Vec3(-(C * three(flow, 3))), held.options.most_torque);
  angular_damping_ += angular_share * C;
  const Vec3 torque = torque_spring - angular_share * (C * three(flow, 3));
  held.most_force = std::max(held.most_force, norm(force));
  effort_ = effort_ - to_vec(force, torque);
}

}  // namespace repel::network
