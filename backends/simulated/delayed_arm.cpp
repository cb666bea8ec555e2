// SPDX-License-Identifier: BSD-3-Clause
#include <repel/simulated/delayed_arm.hpp>

#include <algorithm>
#include <utility>

#include <repel/base/setup_error.hpp>

namespace repel {

DelayedArm::DelayedArm(std::unique_ptr<TorqueDrivenArm> arm, std::size_t joints, int delay)
    : WrappedArm(std::move(arm)),
      joints_(joints),
      under_way_(joints * static_cast<std::size_t>(checked("delay", delay, 0, 100, "ticks"))) {}

void DelayedArm::set_torques(std::span<const double> torques) noexcept {
  if (under_way_.empty() || torques.size() != joints_) return inside().set_torques(torques);
  const std::span<double> oldest = std::span(under_way_).subspan(at_, joints_);
  inside().set_torques(oldest);
  std::copy(torques.begin(), torques.end(), oldest.begin());
  at_ = (at_ + joints_) % under_way_.size();
}

}  // namespace repel
