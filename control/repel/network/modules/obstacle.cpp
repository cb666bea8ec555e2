// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/modules/obstacle.hpp>

#include <repel/base/setup_error.hpp>
#include <repel/network/elements/two_port.hpp>

namespace repel::network {

Obstacle::Obstacle(const ObstacleOptions& options)
    : controller_(options.passivity, weight_of(options.passivity)) {
  const PassivityOptions& p = options.passivity;
  checked("most energy", p.most_energy, 0.0, 1e6, "J");
  checked("most damping", p.most_damping, 0.0, 1e6, "N s/m");
  checked("lever", p.lever, 1e-6, 100.0, "m");
}

void Obstacle::read(const Signals& signals) noexcept {
  const Vec<any_size> flow = signals.tool_flow();
  effort_ = -to_vec(signals.walls);
  if (signals.released) {
    controller_.reset();
    effort_.setZero(6);
    supplied_ = damping_ = 0.0;
    return;
  }
  const Six mean = signals.mean_tool_flow();
  supplied_ = signals.walls_power;
  damping_ = controller_.step(effort_, flow, mean, signals.period, supplied_, signals.since_last());
  if (damping_ > 0.0) effort_ += damping_ * product(Vec<any_size>(controller_.weight()), flow);
}

bool Obstacle::reflected(const Equivalent<any_size>& behind,
                         Equivalent<any_size>& shown) const noexcept {
  return series::shown(behind, effort_, shown);
}

void Obstacle::incident(const PortState<any_size>& at_root, const Equivalent<any_size>& /*behind*/,
                        PortState<any_size>& at_leaf) const noexcept {
  series::pass(at_root, effort_, at_leaf);
}

void Obstacle::add_walls(const Jacobian& jacobian, Vec<any_size>& torques) const noexcept {
  Vec<any_size> at_joints;
  dense::transposed_product(jacobian, effort_, at_joints);
  torques -= at_joints;
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

Obstacle::Six Obstacle::weight_of(const PassivityOptions& options) {
  const double square = options.lever * options.lever;
  Six weight;
  for (int i = 0; i < 6; ++i) weight[i] = i < 3 ? 1.0 : square;
  return weight;
}

}  // namespace repel::network
