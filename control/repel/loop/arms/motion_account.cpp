// SPDX-License-Identifier: BSD-3-Clause
#include <repel/loop/arms/motion_account.hpp>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace repel {

void MotionAccount::step(const std::vector<double>& last, const std::vector<double>& v,
                         const ArmInertia::Matrix& M, const SentTorques& sent,
                         double elapsed) noexcept {
  const double share = std::min(1.0, elapsed / memory);
  double kinetic = 0.0;          // [J]
  double work = 0.0;             // [J]
  const double* row = M.data();  // M is symmetric
  for (std::size_t i = 0; i < v.size(); ++i, row += v.size()) {
    double momentum = 0.0;
    double change = 0.0;
    for (std::size_t k = 0; k < v.size(); ++k) {
      momentum += row[k] * v[k];
      change += row[k] * (v[k] - last[k]);
    }
    kinetic += 0.5 * momentum * v[i];
    const double mean = 0.5 * (v[i] + last[i]);
    const double acted = sent.acted(i) - model_.links[i].viscous_friction * mean;
    work += elapsed * mean * (acted + others_[i]);
    others_[i] += share * (change / elapsed - acted - others_[i]);
  }
  if (is_known_) gained_ += kinetic - kinetic_ - work;
  kinetic_ = kinetic;
  is_known_ = true;
}

}  // namespace repel
