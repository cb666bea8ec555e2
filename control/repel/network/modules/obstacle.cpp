// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/modules/obstacle.hpp>

namespace repel::network {

Obstacle::Obstacle(const ObstacleOptions& options)
    : ToolSource(checked_passivity(options.passivity)) {}

void Obstacle::read(const Signals& signals) noexcept {
  const Vec<any_size> flow = signals.tool_flow();
  effort_ = -to_vec(signals.walls);
  if (signals.released) {
    controller_.reset();
    effort_.setZero(6);
    supplied_ = damping_ = 0.0;
    return;
  }
  supplied_ = signals.walls_power;
  keep_passive(signals, flow);
}

void Obstacle::add_wall_damping(const Jacobian& jacobian, Mat<any_size>& damping) const noexcept {
  if (!(damping_ > 0.0)) return;
  for (Eigen::Index i = 0; i < damping.rows(); ++i) {
    for (Eigen::Index k = 0; k < damping.cols(); ++k) {
      double sum = 0.0;
      for (int row = 0; row < 6; ++row) {
        sum += controller_.weight()[row] * jacobian.coeff(row, i) * jacobian.coeff(row, k);
      }
      damping.coeffRef(i, k) += damping_ * sum;
    }
  }
}

}  // namespace repel::network
