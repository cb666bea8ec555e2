// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/modules/arm_obstacle.hpp>

#include <repel/base/setup_error.hpp>

namespace repel::network {

ArmObstacle::ArmObstacle(const ArmObstacleOptions& options)
    : options_(checked_fields(options)),
      controller_(passivity_of(options), Vec<any_size>::Ones(1)) {}

void ArmObstacle::fit(Space /*space*/, int size) {
  controller_ = PassivityController<any_size>(passivity_of(options_), Vec<any_size>::Ones(size));
  effort_.setZero(size);
}

void ArmObstacle::read(const Signals& signals) noexcept {
  effort_ = -signals.arm_torques;
  if (signals.released) {
    controller_.reset();
    effort_.setZero();
    supplied_ = damping_ = 0.0;
    return;
  }
  supplied_ = signals.arm_power;
  damping_ = controller_.step(effort_, signals.rates, signals.mean_rates, signals.period, supplied_,
                              signals.since_last());
  if (damping_ > 0.0) effort_ += damping_ * signals.rates;
}

void ArmObstacle::add_wall_damping(const Jacobian& /*of_tool*/,
                                   Mat<any_size>& damping) const noexcept {
  for (Eigen::Index i = 0; i < damping.rows(); ++i) damping.coeffRef(i, i) += damping_;
}

PassivityOptions ArmObstacle::passivity_of(const ArmObstacleOptions& options) {
  return {.most_energy = options.most_energy, .most_damping = options.most_damping, .lever = 1.0};
}

}  // namespace repel::network
