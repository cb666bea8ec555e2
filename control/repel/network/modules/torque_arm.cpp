// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/modules/torque_arm.hpp>

#include <repel/base/setup_error.hpp>

namespace repel::network {

TorqueArm::TorqueArm(const TorqueArmOptions& options) : options_(checked_fields(options)) {}

void TorqueArm::prepare(double period) {
  axis_ = HeldAxis({options_.inertia, options_.friction, options_.hand_stiffness,
                    options_.hand_damping, options_.torque_limit},
                   detail::checked_period(period));
  resistance_(0) = axis_.resistance();
}

void TorqueArm::read(const Signals& signals) noexcept {
  axis_.move(signals.of(options_.hand).lever_rate, signals.at_rest);
}

}  // namespace repel::network
