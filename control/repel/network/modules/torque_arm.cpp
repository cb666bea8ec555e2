// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/modules/torque_arm.hpp>

#include <repel/base/setup_error.hpp>

namespace repel::network {

TorqueArm::TorqueArm(const TorqueArmOptions& options) : options_(options) {
  checked("inertia", options.inertia, 1e-6, 1e3, "kg m^2");
  checked("friction", options.friction, 0.0, 1e3, "N m s/rad");
  checked("hand stiffness", options.hand_stiffness, 0.0, 1e5, "N m/rad");
  checked("hand damping", options.hand_damping, 0.0, 1e4, "N m s/rad");
  checked("torque limit", options.torque_limit, 0.0, 1e4, "N m");
}

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
