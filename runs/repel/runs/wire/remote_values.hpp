// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The values between site and station besides waves.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <type_traits>

#include <Eigen/Geometry>

#include <repel/loop/record.hpp>
#include <repel/network/operator.hpp>
#include <repel/network/remote/link.hpp>
#include <repel/runs/operator/operator_input.hpp>

namespace repel::runs {

/// The state of a loose part at the site.
struct PartState {
  enum class Where : std::uint8_t { absent, lies_free, is_held };

  std::int32_t part = -1;  ///< its place in Scene::loose; -1: of none
  Where where = Where::absent;
  Pose X = Pose::Identity();  ///< [m] in the world; of a held one in the tool
};

/// The state of the robot for the operator.
struct SiteState {
  bool is_told = false;          ///< false: nothing was said yet
  Pose X_WT = Pose::Identity();  ///< [m]
  Wrench virtual_force;          ///< [N, N m] on the tool, about its origin, in W
  double gain = 0.0;             ///< of the operator's force
  double nearest = 0.0;          ///< [m]; 1e9 when nothing is near
  double time = 0.0;             ///< [s] of the site
  Status status = 0;
  Vec3 v_WT{0, 0, 0};                            ///< [m/s] tool
  Wrench coupling;                               ///< TickRecord::coupling
  std::array<double, network::most_joints> q{};  ///< [rad] or [m] joints, zeros beyond the last
  PartState part;                                ///< one of them, another one in each tick
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

/// A number not finite would make the whole packet unsound.
[[nodiscard]] inline double or_zero(double x) noexcept {
  return std::isfinite(x) ? x : 0.0;
}
[[nodiscard]] inline Vec3 or_zero(const Vec3& v) noexcept {
  return v.allFinite() ? v : Vec3::Zero();
}

/// The vector, no longer than `most`.
[[nodiscard]] inline Vec3 within(const Vec3& v, double most) noexcept {
  const double largest = largest_entry(v);
  if (!(largest > most)) return v.norm() > most ? Vec3(v * (most / v.norm())) : v;
  const Vec3 unit = v / largest;  // its square is within the range of numbers
  return unit * (most / unit.norm());
}

/// A set of bits as told; -1 if invalid.
[[nodiscard]] inline std::int32_t bits_of(double told) noexcept {
  return told >= 0.0 && told < 2147483648.0 ? static_cast<std::int32_t>(told) : -1;
}

/// A number, bits or a vector; `none` if not finite.
template <class Value, class Numbers>
void put(const Value& value, const Value& none, Row<Numbers>& row) noexcept {
  if constexpr (std::is_same_v<Value, Vec3>) {
    row.put(value);
  } else {
    const auto number = static_cast<double>(value);
    row.next() = std::isfinite(number) ? number : static_cast<double>(none);
  }
}

/// @param hand HandInput::is_finite
template <class Numbers>
void put(const network::HandInput& hand, Row<Numbers>& row) noexcept {
  const network::HandInput none;
  network::for_each_field([&row](const network::HandField& /*field*/, const auto& x,
                                 const auto& otherwise) { put(x, otherwise, row); },
                          hand, none);
}

template <class Numbers>
[[nodiscard]] network::HandInput read_hand(Row<Numbers>& row) noexcept {
  network::HandInput hand;
  network::for_each_field(
      [&row](const network::HandField& field, auto& x) {
        using Value = std::remove_cvref_t<decltype(x)>;
        if constexpr (std::is_same_v<Value, Vec3>) {
          x = row.vec3();
          if (std::isfinite(field.most)) x = within(x, field.most);
        } else if constexpr (std::is_same_v<Value, double>) {
          x = row.next();
        } else {
          x = bits_of(row.next());
        }
      },
      hand);
  return hand;
}

template <class Numbers>
void put(const PartState& told, Row<Numbers>& row) noexcept {
  row.next() = static_cast<double>(told.part);
  row.next() = static_cast<double>(told.where);
  row.put(told.X.translation());
  const Eigen::Quaterniond turn(told.X.linear());
  for (const double x : {turn.w(), turn.x(), turn.y(), turn.z()}) row.next() = x;
}

/// Without a part if the pose told is invalid.
template <class Numbers>
[[nodiscard]] PartState read_part(Row<Numbers>& row) noexcept {
  PartState told;
  told.part = bits_of(row.next());
  const double where = row.next();
  if (where == 1.0) told.where = PartState::Where::lies_free;
  if (where == 2.0) told.where = PartState::Where::is_held;
  told.X.translation() = row.vec3();
  Eigen::Quaterniond turn;
  for (double* x : {&turn.w(), &turn.x(), &turn.y(), &turn.z()}) *x = row.next();
  told.X.linear() = turn.normalized().toRotationMatrix();
  if (!is_rigid(told.X)) told = {};
  return told;
}

}  // namespace detail

/// From the station to the site. A command not finite is sent as unsound.
inline void tell(const network::Command& command, network::RemoteLink& link) noexcept {
  const network::HandInput& hand = command.hand;
  const network::HandInput& second = command.second;
  const bool finite = hand.is_finite() && second.is_finite() && std::isfinite(command.silent_for);
  detail::Row row(link.values());
  row.next() = finite && command.sound ? 1.0 : 0.0;
  row.next() = static_cast<double>(command.phase);
  if (!finite) return;
  row.next() = command.silent_for;
  detail::put(hand, row);
  detail::put(second, row);
}

/// The last command heard by the site. Once the link has been silent for 0.1 s the operator is
/// silent as well, and before the station was heard; a shorter silence is jitter, or a few packets
/// lost.
[[nodiscard]] inline network::Command heard_command(const network::RemoteLink& link) noexcept {
  network::Command command;
  detail::Row row(link.heard());
  command.sound = row.next() == 1.0 || !link.is_linked();
  command.phase = std::max(0, detail::bits_of(row.next()));
  command.silent_for = std::max(0.0, row.next());
  command.hand = detail::read_hand(row);
  command.second = detail::read_hand(row);
  if (!link.is_linked()) command.hand = command.second = {};
  if (!link.is_linked() || link.silent_for() > network::WavePlayer::silence) {
    command.silent_for = std::max(OperatorInput::silent_after, link.silent_for());
    // A hand moving as the line fell silent is not known to move on.
    command.hand.rest();
    command.second.rest();
  }
  return command;
}

/// From the site to the station. @param part a loose one
inline void tell(const TickRecord& record, const Pose& X_WT, const PartState& part,
                 network::RemoteLink& link) noexcept {
  detail::Row row(link.values());
  for (int k = 0; k < 3; ++k) row.put(X_WT.linear().col(k));
  row.put(X_WT.translation());
  row.put(record.virtual_force.force);
  row.put(record.virtual_force.torque);
  row.next() = record.gain;
  row.next() = std::min(record.pairs.nearest, 1e9);
  row.next() = record.time;
  row.next() = static_cast<double>(record.status);
  row.put(detail::or_zero(record.v_WT));
  row.put(detail::or_zero(record.coupling.force));
  row.put(detail::or_zero(record.coupling.torque));
  for (const double q : record.q) row.next() = detail::or_zero(q);
  detail::put(part, row);
}

/// The last state heard by the station.
[[nodiscard]] inline SiteState heard_state(const network::RemoteLink& link) noexcept {
  SiteState state;
  if (!link.is_linked()) return state;
  detail::Row row(link.heard());
  for (int k = 0; k < 3; ++k) state.X_WT.linear().col(k) = row.vec3();
  state.X_WT.translation() = row.vec3();
  // The first packet of a site says nothing yet. A stranger's packet with these agreements is
  // conceivable, too; an invalid pose would spread.
  if (!is_rigid(state.X_WT)) return {};
  state.is_told = true;
  state.virtual_force.force = row.vec3();
  state.virtual_force.torque = row.vec3();
  state.gain = std::clamp(row.next(), 0.0, 1.0);
  state.nearest = row.next();
  state.time = row.next();
  const double status = row.next();
  state.status = status >= 0.0 && status < 4294967296.0 ? static_cast<Status>(status) : 0;
  state.v_WT = row.vec3();
  state.coupling.force = row.vec3();
  state.coupling.torque = row.vec3();
  for (double& q : state.q) q = row.next();
  state.part = detail::read_part(row);
  return state;
}

}  // namespace repel::runs
