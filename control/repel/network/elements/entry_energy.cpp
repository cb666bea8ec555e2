// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/elements/entry_energy.hpp>

#include <algorithm>

namespace repel::network {

void EntryEnergy::begin(double spare, double period) noexcept {
  spare_ = std::max(0.0, spare);
  spent_ = 0.0;
  left_ = std::min(most_, left_ + most_ * period / refill);
}

double EntryEnergy::raised(double gain, double target, double step, double energy) noexcept {
  double more = std::min(target - gain, step);
  if (!(more > 0.0)) return gain;
  const double cost = more * energy;
  const double there = spare_ + left_;
  if (cost > there) more *= there / cost;
  const double own = std::clamp(std::min(cost, there) - spare_, 0.0, left_);
  spare_ = std::max(0.0, spare_ - cost);
  left_ -= own;
  spent_ += own;
  return gain + more;
}

}  // namespace repel::network
