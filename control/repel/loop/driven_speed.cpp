// SPDX-License-Identifier: BSD-3-Clause
#include <repel/loop/driven_speed.hpp>

#include <algorithm>
#include <cmath>

#include <repel/network/elements/dense.hpp>

namespace repel {

double share_within(const network::Jacobian& jacobian, const ArmInertia::Vector& v,
                    const ArmInertia::Vector& torques, const ArmInertia& inertia, double horizon,
                    double limit) noexcept {
  ArmInertia::Matrix mobility = inertia.matrix();
  if (!network::dense::invert_positive(mobility.data(), mobility.rows())) return 1.0;
  const auto gained = network::dense::product<ArmInertia::Vector>(mobility, torques);
  const auto tool = network::dense::product<ArmInertia::Vector>(jacobian, v);
  const auto more = network::dense::product<ArmInertia::Vector>(jacobian, gained);
  double speed = 0.0, along = 0.0, square = 0.0;  // |V|^2, V.A, |A|^2
  for (Eigen::Index i = 0; i < 3; ++i) {
    const double a = horizon * more.coeff(i);
    speed += tool.coeff(i) * tool.coeff(i);
    along += tool.coeff(i) * a;
    square += a * a;
  }
  const double room = limit * limit - speed;
  if (!(square > 0.0)) return 1.0;
  if (room <= 0.0) return along > 0.0 ? 0.0 : 1.0;
  const double share = (std::sqrt(along * along + square * room) - along) / square;
  return share - share == 0.0 ? std::min(1.0, share) : 1.0;
}

}  // namespace repel
