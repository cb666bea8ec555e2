// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/remote/wave_player.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace repel::network {

WavePlayer::WavePlayer(int size, double period, const PlayoutOptions& options)
    : playout_(period, options), period_(period) {
  for (Entry& entry : entries_) entry.waves.clear(size);
  played_.clear(size);
  wave_ = played_.sum;
}

bool WavePlayer::is_credible(const RemotePacket& packet) const noexcept {
  if (!(packet.energy_sent <= longest * most_power_)) return false;
  const double most = longest * std::sqrt(most_power_);
  return std::all_of(packet.sum.begin(), packet.sum.end(),
                     [&](double x) { return std::abs(x) <= most; });
}

void WavePlayer::begin() noexcept {
  for (Entry& entry : entries_) entry.sequence = 0;
  newest_ = 0;
  output_ = 0.0;
  credit_ = 0.0;
  is_beyond_ = false;
}

bool WavePlayer::arrive(const RemotePacket& packet, double now) noexcept {
  const double sent = 1e-9 * static_cast<double>(packet.sent);
  const bool anew = newest_ == 0 || now - last_arrival_ > silence;
  if (!is_credible(packet)) return false;
  if (packet.sequence > newest_) {
    const double before = anew ? sent : at(newest_).sent;
    if (!anew && !follows(at(newest_), packet, sent - before)) return false;
    if (!anew && !can_pay(packet.energy_sent - at(newest_).waves.energy, sent - before, now)) {
      return false;
    }
    if (anew) playout_.begin();
    playout_.arrive(sent, before, now);
    newest_ = packet.sequence;
    last_arrival_ = now;
  } else if (newest_ - packet.sequence >= static_cast<std::int64_t>(kept) ||
             at(packet.sequence).sequence == packet.sequence || !precedes(packet, sent)) {
    return false;
  }
  Entry& entry = at(packet.sequence);
  entry.sequence = packet.sequence;
  entry.sent = sent;
  entry.waves.energy = packet.energy_sent;
  for (Eigen::Index i = 0; i < entry.waves.sum.size(); ++i) {
    entry.waves.sum.coeffRef(i) = packet.sum[static_cast<std::size_t>(i)];
  }
  if (anew) {
    oldest_ = packet.sequence;
    begins_anew_ = true;
  }
  return true;
}

const Vec<any_size>& WavePlayer::step(double now, bool at_rest) noexcept {
  wave_.setZero();
  if (newest_ == 0) return wave_;
  const double before = moment_;
  moment_ = playout_.advance(now);
  const WaveAccount due = account(moment_);
  if (begins_anew_ || at_rest) {
    played_ = due;
    begins_anew_ = false;
    return wave_;
  }
  // Both by what is known now. Late data are added later, at a limited rate, so that nothing jumps
  // when they come.
  const WaveAccount last = account(before);
  const double share = std::min(1.0, period_ / catch_up);
  const Vec<any_size> wanted = due.sum - last.sum + share * (last.sum - played_.sum);
  const double spent = played_.energy;
  wave_ = played_.draw(wanted, due.energy - spent, period_);
  output_ += played_.energy - spent;
  return wave_;
}

double WavePlayer::withheld() const noexcept {
  return newest_ == 0 ? 0.0 : at(newest_).waves.energy - output_;
}

bool WavePlayer::are_possible(double energy, double square, double all,
                              double elapsed) const noexcept {
  constexpr double rounding = 1e-11;  // of all that was sent so far, in many ticks
  return elapsed > 0.0 && energy >= 0.0 &&
         square <= (energy + rounding * all) * (elapsed + slack) * (1.0 + 1e-6);
}

double WavePlayer::square_between(const Entry& entry, const RemotePacket& packet) const noexcept {
  double square = 0.0;
  for (Eigen::Index i = 0; i < entry.waves.sum.size(); ++i) {
    const double off = packet.sum[static_cast<std::size_t>(i)] - entry.waves.sum.coeff(i);
    square += off * off;
  }
  return square;
}

bool WavePlayer::follows(const Entry& last, const RemotePacket& packet,
                         double elapsed) const noexcept {
  return are_possible(packet.energy_sent - last.waves.energy, square_between(last, packet),
                      packet.energy_sent, elapsed);
}

bool WavePlayer::precedes(const RemotePacket& packet, double sent) const noexcept {
  const Entry& last = at(newest_);
  return are_possible(last.waves.energy - packet.energy_sent, square_between(last, packet),
                      last.waves.energy, last.sent - sent);
}

bool WavePlayer::can_pay(double energy, double elapsed, double now) noexcept {
  const double time = std::min(elapsed, now - last_arrival_ + late);
  if (energy > absurd * most_power_ * (time + slack)) return false;
  credit_ = std::min(credit_ + 1.01 * most_power_ * time, most_power_ * slack) - energy;
  is_beyond_ = credit_ < -most_power_ * slack;
  credit_ = std::max(credit_, -most_power_ * slack);
  return true;
}

WavePlayer::Entry& WavePlayer::at(std::int64_t sequence) noexcept {
  return entries_[static_cast<std::size_t>(sequence) % kept];
}

const WavePlayer::Entry& WavePlayer::at(std::int64_t sequence) const noexcept {
  return entries_[static_cast<std::size_t>(sequence) % kept];
}

WaveAccount WavePlayer::account(double moment) const noexcept {
  const Entry* after = nullptr;
  const std::int64_t first = std::max(oldest_, newest_ - static_cast<std::int64_t>(kept) + 1);
  for (std::int64_t i = newest_; i >= first; --i) {
    const Entry& entry = at(i);
    if (entry.sequence != i) continue;
    if (entry.sent > moment) {
      after = &entry;
      continue;
    }
    if (after == nullptr) return entry.waves;
    const double share = (moment - entry.sent) / (after->sent - entry.sent);
    WaveAccount between = entry.waves;
    between.energy += share * (after->waves.energy - between.energy);
    between.sum += share * (after->waves.sum - between.sum);
    return between;
  }
  return after->waves;
}

}  // namespace repel::network
