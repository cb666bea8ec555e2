// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Chatter: how rough the forces and torques of a run are, measured while it runs.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include <repel/loop/record.hpp>

namespace repel::runs {

/// [Hz] A force above this frequency is felt as roughness instead of as a motion of the hand.
inline constexpr double chatter_above_hz = 30.0;

/// Chatter of a signal, in the unit of the signal.
struct Chatter {
  /// Root mean square above `chatter_above_hz`; NaN if unknown: without a sample, and at tick rates
  /// up to twice that frequency.
  double rms = std::numeric_limits<double>::quiet_NaN();
  double jump = 0.0;  ///< largest change from one tick to the next, without sign
};

/// Measures the chatter of signals sampled together, in bounded memory for a run of any length: a
/// Butterworth high pass of fourth order at 30 Hz for each signal, and the sum of its squares.
///
/// The offline form, `telepresence::rms_above`, has all samples at hand and cuts sharply. Of a
/// steady signal both give the same within 3 %, except for content near the cutoff: of a sine at
/// 30 Hz the filter passes 0.71, at 20 Hz 0.19, at 10 Hz 0.01. Where a signal changes in the course
/// of the run, this is the root mean square over all of it, while the window of the offline form
/// weights the middle.
class ChatterMeter {
 public:
  /// Allocates; nothing else does. @param rate_hz [Hz] of the samples
  ChatterMeter(std::size_t signals, double rate_hz);

  /// Adds a sample of every signal, in their order. A sample with a value not finite is left out,
  /// as a gap. Cost: some twenty floating-point operations for each signal.
  void add(std::span<const double> samples) noexcept;

  /// The next samples do not follow the last ones: their difference is no jump, and the filters
  /// begin as if they had been constant before.
  void gap() noexcept { begins_ = true; }

  /// Of all samples so far.
  [[nodiscard]] Chatter of(std::size_t signal) const noexcept;

 private:
  /// A section of second order, y / x = gain (1 - z^-1)^2 / (1 + a1 z^-1 + a2 z^-2).
  struct Section {
    double gain = 0.0;
    double a1 = 0.0;
    double a2 = 0.0;
  };
  struct Signal {
    double base = 0.0;  ///< value after the last gap, hidden from the filter
    double last = 0.0;
    double jump = 0.0;
    double squares = 0.0;
    std::array<std::array<double, 2>, 2> state{};  ///< of each section, in transposed form
  };

  [[nodiscard]] double filtered(Signal& signal, double sample) const noexcept;

  std::vector<Signal> signals_;
  std::array<Section, 2> sections_{};
  bool has_rms_ = false;
  bool begins_ = true;
  std::int64_t count_ = 0;
};

/// Chatter of an arm. Of a vector it is that of the worst axis of the world; root mean square and
/// jump may be of different axes.
struct ArmChatter {
  Chatter wall_force;              ///< [N] virtual force on the tool
  Chatter wall_torque;             ///< [N m] virtual torque on it, about the origin of its frame
  std::vector<Chatter> joints{};   ///< [N m] or [N] commanded torque or force, base outward
  std::optional<Chatter> lever{};  ///< [N m] torque reflected to the torque arm, if it has one
};

/// Measures the chatter of an arm from the records of its ticks.
class ArmChatterMeter {
 public:
  /// Allocates; nothing else does but `result`. @param rate_hz [Hz] of the ticks
  ArmChatterMeter(std::size_t joints, bool has_lever, double rate_hz);

  /// Adds a tick. One later than a period after the last is no jump: see ChatterMeter::gap.
  void add(const TickRecord& record) noexcept;

  /// The next tick does not follow the last one, as after a pause.
  void gap() noexcept { meter_.gap(); }

  [[nodiscard]] ArmChatter result() const;

 private:
  std::size_t joints_;
  bool has_lever_;
  std::vector<double> samples_;  ///< force, torque, lever, joints
  ChatterMeter meter_;
};

}  // namespace repel::runs
