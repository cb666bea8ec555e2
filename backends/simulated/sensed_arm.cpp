// SPDX-License-Identifier: BSD-3-Clause
#include <repel/simulated/sensed_arm.hpp>

#include <utility>

#include <repel/base/setup_error.hpp>

namespace repel {

bool SensorErrors::none() const noexcept {
  return force_noise == 0.0 && torque_noise == 0.0 && bias.force.isZero(0.0) &&
         bias.torque.isZero(0.0);
}

SensedArm::SensedArm(std::unique_ptr<TorqueDrivenArm> arm, const SensorErrors& errors)
    : WrappedArm(std::move(arm)), errors_(errors), rng_(errors.seed) {
  checked("noise of the force", errors.force_noise, 0.0, 1e6, "N");
  checked("noise of the torque", errors.torque_noise, 0.0, 1e6, "N m");
  checked("bias of the force", errors.bias.force.norm(), 0.0, 1e7, "N");
  checked("bias of the torque", errors.bias.torque.norm(), 0.0, 1e7, "N m");
  draw();
}

void SensedArm::step(double period) noexcept {
  inside().step(period);
  draw();
}

std::optional<Wrench> SensedArm::read_wrench() const noexcept {
  const std::optional<Wrench> exact = inside().read_wrench();
  return exact ? std::optional(*exact + error_) : std::nullopt;
}

void SensedArm::draw() noexcept {
  error_ = errors_.bias;
  for (Eigen::Index i = 0; i < 3; ++i) {
    error_.force.coeffRef(i) += errors_.force_noise * uniform();
    error_.torque.coeffRef(i) += errors_.torque_noise * uniform();
  }
}

double SensedArm::uniform() noexcept {
  return static_cast<double>(rng_() >> 11U) * 0x1p-52 - 1.0;
}

}  // namespace repel
