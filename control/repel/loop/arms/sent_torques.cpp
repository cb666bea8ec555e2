// SPDX-License-Identifier: BSD-3-Clause
#include <repel/loop/arms/sent_torques.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace repel {

SentTorques::SentTorques(std::size_t joints, double delay)
    : delay_(delay), ring_(static_cast<std::size_t>(std::ceil(delay)) + 1) {
  for (Vector& sent : ring_) sent.setZero(static_cast<Eigen::Index>(joints));
}

void SentTorques::add(const Vector& net, double share) noexcept {
  newest_ = (newest_ + 1) % ring_.size();
  ring_[newest_] = share * net;
}

double SentTorques::acted(std::size_t joint) const noexcept {
  const auto whole = static_cast<std::size_t>(delay_);
  const double rest = delay_ - static_cast<double>(whole);
  const double later = ago(whole, joint);
  return rest > 0.0 ? later + rest * (ago(whole + 1, joint) - later) : later;
}

double SentTorques::surely(std::size_t joint) const noexcept {
  double least = ago(0, joint);
  for (std::size_t k = 1; k < ring_.size(); ++k) {
    const double sent = ago(k, joint);
    if (!(least * sent > 0.0)) return 0.0;
    if (std::abs(sent) < std::abs(least)) least = sent;
  }
  return least;
}

double SentTorques::at_most(std::size_t joint) const noexcept {
  double most = 0.0;
  for (std::size_t k = 0; k < ring_.size(); ++k) most = std::max(most, std::abs(ago(k, joint)));
  return most;
}

double SentTorques::ago(std::size_t ticks, std::size_t joint) const noexcept {
  const Vector& sent = ring_[(newest_ + ring_.size() - ticks) % ring_.size()];
  return sent.coeff(static_cast<Eigen::Index>(joint));
}

}  // namespace repel
