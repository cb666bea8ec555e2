// SPDX-License-Identifier: BSD-3-Clause
#include <repel/runs/watch/chatter.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace repel::runs {
namespace {

// Where the samples of an arm are.
constexpr std::size_t force_at = 0;
constexpr std::size_t torque_at = 3;
constexpr std::size_t lever_at = 6;
constexpr std::size_t joints_at = 7;

}  // namespace

// Bilinear transform, with the cutoff where it belongs.
ChatterMeter::ChatterMeter(std::size_t signals, double rate_hz)
    : signals_(signals), has_rms_(rate_hz > 2.0 * chatter_above_hz) {
  if (!has_rms_) return;
  const double k = std::tan(std::numbers::pi * chatter_above_hz / rate_hz);
  for (std::size_t i = 0; i < sections_.size(); ++i) {
    const double angle = std::numbers::pi * (2.0 * static_cast<double>(i) + 1.0) / 8.0;
    const double damping = 2.0 * std::cos(angle);  // of a pair of the four poles
    const double scale = 1.0 / (1.0 + damping * k + k * k);
    sections_[i] = {scale, 2.0 * (k * k - 1.0) * scale, (1.0 - damping * k + k * k) * scale};
  }
}

void ChatterMeter::add(std::span<const double> samples) noexcept {
  if (!std::all_of(samples.begin(), samples.end(), [](double x) { return std::isfinite(x); })) {
    gap();
    return;
  }
  for (std::size_t i = 0; i < signals_.size(); ++i) {
    Signal& signal = signals_[i];
    if (begins_) {
      signal.base = samples[i];
      signal.state = {};
    } else {
      signal.jump = std::max(signal.jump, std::abs(samples[i] - signal.last));
    }
    signal.last = samples[i];
    if (!has_rms_) continue;
    const double rough = filtered(signal, samples[i] - signal.base);
    signal.squares += rough * rough;
  }
  begins_ = false;
  ++count_;
}

double ChatterMeter::filtered(Signal& signal, double sample) const noexcept {
  for (std::size_t i = 0; i < sections_.size(); ++i) {
    const Section& section = sections_[i];
    std::array<double, 2>& state = signal.state[i];
    const double in = section.gain * sample;
    const double out = in + state[0];
    state[0] = -2.0 * in - section.a1 * out + state[1];
    state[1] = in - section.a2 * out;
    sample = out;
  }
  return sample;
}

Chatter ChatterMeter::of(std::size_t signal) const noexcept {
  Chatter chatter{.jump = signals_[signal].jump};
  if (has_rms_ && count_ > 0) {
    chatter.rms = std::sqrt(signals_[signal].squares / static_cast<double>(count_));
  }
  return chatter;
}

ArmChatterMeter::ArmChatterMeter(std::size_t joints, bool has_lever, double rate_hz)
    : joints_(joints),
      has_lever_(has_lever),
      samples_(joints_at + joints),
      meter_(samples_.size(), rate_hz) {}

void ArmChatterMeter::add(const TickRecord& record) noexcept {
  if (record.elapsed != 1) gap();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto row = static_cast<Eigen::Index>(axis);
    samples_[force_at + axis] = record.virtual_force.force[row];
    samples_[torque_at + axis] = record.virtual_force.torque[row];
  }
  samples_[lever_at] = record.lever_torque;
  std::copy_n(record.torques.begin(), joints_, samples_.begin() + joints_at);
  meter_.add(samples_);
}

ArmChatter ArmChatterMeter::result() const {
  const auto worst = [this](std::size_t at) {
    Chatter worst_axis = meter_.of(at);
    for (std::size_t axis = 1; axis < 3; ++axis) {
      const Chatter other = meter_.of(at + axis);
      worst_axis.rms = std::max(worst_axis.rms, other.rms);
      worst_axis.jump = std::max(worst_axis.jump, other.jump);
    }
    return worst_axis;
  };
  ArmChatter chatter{.wall_force = worst(force_at), .wall_torque = worst(torque_at)};
  for (std::size_t i = 0; i < joints_; ++i) chatter.joints.push_back(meter_.of(joints_at + i));
  if (has_lever_) chatter.lever = meter_.of(lever_at);
  return chatter;
}

}  // namespace repel::runs
