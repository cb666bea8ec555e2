/// @file
/// What site and station tell each other besides waves.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include <repel/loop/record.hpp>
#include <repel/network/operator.hpp>
#include <repel/network/remote/link.hpp>

#include "operator_input.hpp"

namespace repel::teleop {

/// What the operator needs to know of the robot.
struct SiteState {
  Pose X_WT = Pose::Identity();  ///< [m]
  Wrench virtual_force;          ///< [N, N m] on the tool, about its origin, in W
  double gain = 0.0;             ///< of the operator's force
  double nearest = 0.0;          ///< [m]; 1e9 when nothing is near
  double time = 0.0;             ///< [s] of the site
  Status status = 0;
};

namespace detail {

/// Writes or reads numbers one after the other.
template <class Numbers>
class Row {
 public:
  explicit Row(Numbers numbers) noexcept : numbers_(numbers) {}
  auto& next() noexcept { return numbers_[at_++]; }
  void put(const Vec3& v) noexcept {
    for (Eigen::Index i = 0; i < 3; ++i) next() = v.coeff(i);
  }
  [[nodiscard]] Vec3 vec3() noexcept {
    Vec3 v;
    for (Eigen::Index i = 0; i < 3; ++i) v.coeffRef(i) = next();
    return v;
  }

 private:
  Numbers numbers_;
  std::size_t at_ = 0;
};

/// A set of bits as told; -1 for what is none.
[[nodiscard]] inline std::int32_t bits_of(double told) noexcept {
  return told >= 0.0 && told < 2147483648.0 ? static_cast<std::int32_t>(told) : -1;
}

}  // namespace detail

/// From the station to the site. A command that is not finite is told as one that is not sound.
inline void tell(const network::Command& command, network::RemoteLink& link) noexcept {
  const network::HandInput& hand = command.hand;
  const network::HandInput& second = command.second;
  const bool finite = hand.is_finite() && second.is_finite() && std::isfinite(command.silent_for);
  detail::Row row(link.values());
  row.next() = finite && command.sound ? 1.0 : 0.0;
  row.next() = static_cast<double>(command.phase);
  if (!finite) return;
  row.next() = command.silent_for;
  row.next() = hand.lever_rate;
  row.put(hand.direction_W);
  row.put(hand.ball.linear);
  row.put(hand.ball.angular);
  row.next() = std::isfinite(hand.scale) ? hand.scale : 1.0;
  row.put(hand.turning_W);
  row.put(second.ball.linear);
  row.put(second.ball.angular);
  row.next() = std::isfinite(second.scale) ? second.scale : 1.0;
  row.next() = static_cast<double>(hand.guides);
  row.next() = std::isfinite(hand.guide_strength) ? hand.guide_strength : 1.0;
  row.next() = static_cast<double>(hand.compliant);
}

/// The command that the site heard last. Once the link has been silent for 0.1 s the operator is
/// silent as well, and before the station was heard; a shorter silence is jitter, or a few packets
/// lost.
[[nodiscard]] inline network::Command heard_command(const network::RemoteLink& link) noexcept {
  network::Command command;
  detail::Row row(link.heard());
  command.sound = row.next() == 1.0 || !link.is_linked();
  command.phase = static_cast<std::int32_t>(row.next());
  command.silent_for = row.next();
  command.hand.lever_rate = row.next();
  command.hand.direction_W = row.vec3();
  command.hand.ball.linear = row.vec3();
  command.hand.ball.angular = row.vec3();
  command.hand.scale = row.next();
  command.hand.turning_W = row.vec3();
  command.second.ball.linear = row.vec3();
  command.second.ball.angular = row.vec3();
  command.second.scale = row.next();
  command.hand.guides = detail::bits_of(row.next());
  command.hand.guide_strength = row.next();
  command.hand.compliant = detail::bits_of(row.next());
  if (!link.is_linked()) command.hand = command.second = {};
  if (!link.is_linked() || link.silent_for() > network::WavePlayer::silence) {
    command.silent_for = std::max(OperatorInput::silent_after, link.silent_for());
    // The hand that moved when the line went silent is not known to move on.
    command.hand.ball = command.second.ball = {};
    command.hand.lever_rate = 0.0;
  }
  return command;
}

/// From the site to the station.
inline void tell(const TickRecord& record, const Pose& X_WT, network::RemoteLink& link) noexcept {
  detail::Row row(link.values());
  for (int k = 0; k < 3; ++k) row.put(X_WT.linear().col(k));
  row.put(X_WT.translation());
  row.put(record.virtual_force.force);
  row.put(record.virtual_force.torque);
  row.next() = record.gain;
  row.next() = std::min(record.pairs.nearest, 1e9);
  row.next() = record.time;
  row.next() = static_cast<double>(record.status);
}

/// What the station heard last.
[[nodiscard]] inline SiteState heard_state(const network::RemoteLink& link) noexcept {
  SiteState state;
  if (!link.is_linked()) return state;
  detail::Row row(link.heard());
  for (int k = 0; k < 3; ++k) state.X_WT.linear().col(k) = row.vec3();
  state.X_WT.translation() = row.vec3();
  state.virtual_force.force = row.vec3();
  state.virtual_force.torque = row.vec3();
  state.gain = row.next();
  state.nearest = row.next();
  state.time = row.next();
  const double status = row.next();
  state.status = status >= 0.0 && status < 4294967296.0 ? static_cast<Status>(status) : 0;
  // A stranger's packet with these agreements is conceivable; a pose that is none would spread.
  if (!is_rigid(state.X_WT)) state.X_WT = Pose::Identity();
  return state;
}

}  // namespace repel::teleop
