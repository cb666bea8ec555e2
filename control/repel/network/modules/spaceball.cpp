// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/modules/spaceball.hpp>

#include <algorithm>

#include <repel/base/setup_error.hpp>

namespace repel::network {

Spaceball::Spaceball(const SpaceballOptions& options) : options_(checked_fields(options)) {}

void Spaceball::read(const Signals& signals) noexcept {
  const Twist& raw = signals.hand.ball;
  const double share = period_ / (period_ + options_.time_constant);
  saturated_ = false;
  const Vec3 linear = shaped(raw.linear, options_.dead_band, options_.saturation);
  const Vec3 angular = shaped(raw.angular, options_.angular_dead_band, options_.angular_saturation);
  twist_.linear += share * (linear - twist_.linear);
  twist_.angular += share * (angular - twist_.angular);
  if (signals.at_rest) twist_ = {};
}

bool Spaceball::reflected(const Equivalent<any_size>& behind,
                          Equivalent<any_size>& shown) const noexcept {
  shown = behind;
  shown.add_flow(sign_ * to_vec(twist_));
  return true;
}

void Spaceball::incident(const PortState<any_size>& at_root, const Equivalent<any_size>& /*behind*/,
                         PortState<any_size>& at_leaf) noexcept {
  const Vec<any_size> flow = sign_ * to_vec(twist_);
  at_leaf.effort = at_root.effort;
  at_leaf.flow = at_root.flow - flow;
  supplied_ = -at_root.effort.dot(flow);
}

Vec3 Spaceball::shaped(const Vec3& v, double dead_band, double most) noexcept {
  const double length = v.norm();
  if (!(length > dead_band)) return {0, 0, 0};
  saturated_ = saturated_ || length - dead_band > most;
  return v * (std::min(length - dead_band, most) / length);
}

}  // namespace repel::network
