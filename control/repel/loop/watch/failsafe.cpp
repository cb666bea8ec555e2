// SPDX-License-Identifier: BSD-3-Clause
#include <repel/loop/watch/failsafe.hpp>

#include <algorithm>

namespace repel {

double Failsafe::step(Status status, double period) noexcept {
  if ((status & status::failsafe) != 0U) {
    sound_for_ = 0.0;
    tripped_ = true;
  } else {
    sound_for_ += period;
  }
  if (tripped_ && (gain_ > 0.0 || sound_for_ < options_.hold)) {
    gain_ = std::max(0.0, gain_ - period / options_.fall);
  } else {
    tripped_ = false;
    gain_ = std::min(1.0, gain_ + period / options_.rise);
  }
  return gain_;
}

}  // namespace repel
