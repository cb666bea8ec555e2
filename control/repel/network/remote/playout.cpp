// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/remote/playout.hpp>

#include <algorithm>
#include <cmath>

#include <repel/base/setup_error.hpp>

namespace repel::network {

Playout::Playout(double period, const PlayoutOptions& options)
    : options_(options), period_(period) {
  checked("buffer", options.buffer, -1.0, 10.0, "s");
  checked("largest buffer", options.most, 0.0, 10.0, "s");
}

void Playout::begin() noexcept {
  older_ = recent_ = {};
  has_begun_ = false;
}

void Playout::arrive(double sent, double before, double now) noexcept {
  newest_ = sent;
  recent_.least = std::min(recent_.least, now - sent);
  recent_.longest = std::max(recent_.longest, now - before);
}

double Playout::advance(double now) noexcept {
  const double least = std::min(older_.least, recent_.least);
  const double longest = std::max(older_.longest, recent_.longest);
  if (!(least < unknown)) return moment_;
  buffer_ = options_.buffer;
  if (buffer_ < 0.0) {
    const double wanted = 1.25 * (longest - least);
    buffer_ = std::max(period_, std::min(wanted, options_.most));
  }
  const double aim = now - least - buffer_;
  const double elapsed = now - last_;
  const double off = aim - (moment_ + elapsed);
  // Less than a period is left alone: arrival times have a resolution of one period.
  const double by = off - std::clamp(off, -period_, period_);
  if (has_begun_ && std::abs(off) < most_off) {
    moment_ += elapsed +
               std::clamp(by, -(moment_ > newest_ ? starving : change) * elapsed, change * elapsed);
  } else {
    moment_ = aim;
    since_ = now;
  }
  has_begun_ = true;
  last_ = now;
  // What is known is kept for as long as nothing arrives.
  if (now - since_ > window && recent_.least < unknown) {
    since_ = now;
    older_ = recent_;
    recent_ = {};
  }
  return moment_;
}

}  // namespace repel::network
