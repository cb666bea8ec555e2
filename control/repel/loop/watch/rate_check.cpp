// SPDX-License-Identifier: BSD-3-Clause
#include <repel/loop/watch/rate_check.hpp>

#include <algorithm>
#include <cmath>

namespace repel {

bool RateCheck::step(double moved, double last_v, double v, double elapsed, bool is_late,
                     const JointWatchOptions& options, double period) noexcept {
  // Between two readings the rate is assumed to lie between theirs.
  const double step = std::abs(v - last_v);
  const double missing = moved - 0.5 * elapsed * (v + last_v);
  const double speed = std::max(std::abs(v), std::abs(last_v));
  if (!(speed < fastest)) {  // would be remembered for long
    forget();
    return false;
  }
  const double bend = 0.5 * elapsed * step;
  double most = options.position_noise + bend;
  if (is_late) most += elapsed * (speed + options.rate_noise);
  const double off = options.jitter * period * speed;
  untold_before_ = untold_;
  drift_ = memory * drift_ + missing;
  change_ = memory * change_ + step;
  time_ = memory * time_ + elapsed;
  if (is_late) {
    slip_ = way_ = 0.0;
  } else {
    const double kept = 1.0 - std::min(1.0, elapsed / long_memory);
    slip_ = kept * slip_ + missing;
    way_ = kept * way_ + std::max(std::abs(moved), elapsed * speed);
    top_ = std::max(kept * top_, speed);
    const double apart = missing - last_missing_;
    scatter_ = kept * scatter_ + 0.5 * apart * apart;
  }
  last_missing_ = missing;
  note(missing, std::abs(moved - last_moved_), bend, elapsed, options);
  last_moved_ = moved;
  const bool follows = std::abs(missing) <= most + off &&
                       std::abs(drift_) <= 3.0 * most + 2.0 * off + 0.6 * elapsed * change_ &&
                       std::abs(slip_) <= options.position_noise +
                                              2.0 * options.jitter * period * top_ +
                                              share_of_way * way_ + 4.0 * std::sqrt(scatter_);
  if (!follows) forget();  // discards implausible data
  return follows;
}

void RateCheck::forget() noexcept {
  drift_ = change_ = time_ = slip_ = way_ = top_ = scatter_ = last_missing_ = untold_ = 0.0;
  last_moved_ = unknown;
}

void RateCheck::note(double missing, double jump, double bend, double elapsed,
                     const JointWatchOptions& options) noexcept {
  const double noise = clear * options.position_noise;
  const auto beyond = [&](double way, double most) { return std::abs(way) > most ? way : 0.0; };
  const double most = 3.0 * noise + bend;
  const double at_once = jump > most ? 0.0 : beyond(missing, most) / elapsed;
  const double lately = beyond(drift_, noise + elapsed * change_) / time_;
  untold_ = std::abs(at_once) > std::abs(lately) ? at_once : lately;
}

}  // namespace repel
