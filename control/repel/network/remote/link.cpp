// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/remote/link.hpp>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <span>

namespace repel::network {

RemoteLink::RemoteLink(const RemoteOptions& options)
    : options_(options), incoming_(room, {}), outgoing_(room, {}) {
  checked("session", static_cast<double>(options.session), 1.0, 0x1p64, "");
}

void RemoteLink::prepare(int size, double period) {
  player_ = WavePlayer(size, period, options_.playout);
  sent_.clear(size);
  size_ = size;
}

void RemoteLink::receive(std::chrono::nanoseconds now) noexcept {
  now_ = now;
  told_ = 0;
  if (began_ < 0) began_ = now.count();
  for (std::size_t i = 0; i < room; ++i) {
    const RemotePacket* packet = incoming_.front();
    if (packet == nullptr) return;
    take(*packet);
    incoming_.pop();
  }
}

void RemoteLink::send(const Vec<any_size>& wave, double period) noexcept {
  if (began_ < 0) return;
  sent_.add(wave, period);
  RemotePacket& packet = outgoing_.draft();
  packet.session = options_.session;
  packet.agreement = options_.agreement;
  packet.sequence = ++counts_.sent;
  packet.sent = now_.count();
  packet.heard = partner_;
  packet.heard_sent = heard_sent_;
  packet.heard_for = partner_ == 0 ? 0 : now_.count() - heard_at_;
  packet.energy_sent = sent_.energy;
  packet.energy_played = player_.output();
  std::copy_n(sent_.sum.data(), size_, packet.sum.begin());
  packet.values = values_;
  // Without room it is lost, as it may be on the way.
  (void)outgoing_.post();
}

std::span<const double, RemotePacket::most_values> RemoteLink::heard() const noexcept {
  return heard_values_;
}

std::span<const std::chrono::nanoseconds> RemoteLink::round_trips() const noexcept {
  return std::span(round_trips_).first(told_);
}

double RemoteLink::silent_for() const noexcept {
  return seconds(now_ - std::chrono::nanoseconds(partner_ == 0 ? began_ : heard_at_));
}

double RemoteLink::seconds(std::chrono::nanoseconds t) noexcept {
  return 1e-9 * static_cast<double>(t.count());
}

void RemoteLink::take(const RemotePacket& packet) noexcept {
  if (packet.agreement != options_.agreement) {
    ++counts_.strangers;
    return;
  }
  if (!is_sound(packet) || packet.session == options_.session || !player_.is_credible(packet)) {
    ++counts_.refused;
    if (packet.session == partner_) distrust();
    return;
  }
  if (packet.session != partner_ && !meet(packet)) {
    ++counts_.strangers;
    return;
  }
  const std::int64_t newest = player_.newest();
  const bool is_newer = packet.sequence > newest;
  if (!player_.arrive(packet, seconds(now_))) {
    ++(is_newer ? counts_.refused : counts_.doubled);
    if (is_newer) distrust();
    return;
  }
  ++counts_.received;
  if (is_newer && player_.is_beyond()) {
    ++counts_.beyond;
    if (distrust()) return;
  } else {
    distrust_ = std::max(0.0, distrust_ - 0.25);
  }
  if (!is_newer) {
    ++counts_.overtaken;
    --counts_.lost;
    return;
  }
  if (newest > 0) {
    counts_.lost += packet.sequence - newest - 1;
    counts_.longest_silence =
        std::max(counts_.longest_silence, 1e-9 * static_cast<double>(now_.count() - heard_at_));
  }
  hear(packet);
}

bool RemoteLink::meet(const RemotePacket& packet) noexcept {
  const bool is_free = partner_ == 0 || silent_for() > WavePlayer::silence;
  if (!is_free || packet.session == former_) return false;
  if (std::find(closed_.begin(), closed_.end(), packet.session) != closed_.end()) return false;
  former_ = partner_;
  partner_ = packet.session;
  distrust_ = 0.0;
  partner_sent_ = partner_played_ = 0.0;
  ++counts_.sessions;
  player_.begin();
  return true;
}

bool RemoteLink::distrust() noexcept {
  if (++distrust_ < patience) return false;
  closed_[static_cast<std::size_t>(counts_.closed++) % closed_.size()] = partner_;
  partner_ = 0;
  began_ = now_.count();
  heard_values_ = {};
  distrust_ = 0.0;
  player_.begin();
  return true;
}

void RemoteLink::hear(const RemotePacket& packet) noexcept {
  heard_at_ = now_.count();
  heard_sent_ = packet.sent;
  heard_values_ = packet.values;
  partner_sent_ = packet.energy_sent;
  if (packet.heard != options_.session) return;
  partner_played_ = packet.energy_played;
  const std::int64_t since = now_.count() - packet.heard_sent;
  if (since < packet.heard_for) return;
  round_trips_[told_++] = std::chrono::nanoseconds(since - packet.heard_for);
}

}  // namespace repel::network
