// SPDX-License-Identifier: BSD-3-Clause
#include <repel/cell/arm_port.hpp>

#include <span>

namespace repel {

ArmReadings ArmPort::read() noexcept {
  arm_->read_positions(q_);
  arm_->read_velocities(v_);
  return {q_, v_, arm_->state(), arm_->read_wrench()};
}

void ArmPort::apply(const TickRecord& record) noexcept {
  if (record.enable) arm_->enable();
  arm_->set_torques(std::span(record.torques).first(q_.size()));
  arm_->engage_brakes(record.brakes);
}

}  // namespace repel
