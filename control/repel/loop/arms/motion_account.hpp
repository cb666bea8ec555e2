// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The energy gained by an arm without work of its torques.
#pragma once

#include <vector>

#include <repel/loop/arms/arm_inertia.hpp>
#include <repel/loop/arms/sent_torques.hpp>
#include <repel/world/arm.hpp>

namespace repel {

/// Compares the kinetic energy by the readings with the work of the torques sent:
///
///     gained = sum of  dE - T v.(tau - g - B v + e)      E = v' M v / 2
///
/// e is the steady disturbance: a payload, an error of the weight, dry friction. It is the
/// low-passed difference of M dv / T and the torques. The gain stays within the error of E while
/// readings and drive are as late as told. If they are later, torque and motion are out of phase,
/// and it grows by the energy the loop believes to take out. Allocates at construction only.
class MotionAccount {
 public:
  using Vector = ArmInertia::Vector;  ///< one entry for each joint

  /// Of an arm at rest.
  explicit MotionAccount(const ArmModel& model) : model_(model), others_(model.links.size()) {}

  /// Advances by a reading. @param last, v [rad/s] rates of the last reading and of this one
  /// @param M the inertia between both @param sent what acted between both @param elapsed [s]
  void step(const std::vector<double>& last, const std::vector<double>& v,
            const ArmInertia::Matrix& M, const SentTorques& sent, double elapsed) noexcept;
  /// The next reading does not follow from the last one.
  void begin_anew() noexcept { is_known_ = false; }

  [[nodiscard]] double gained() const noexcept { return gained_; }    ///< [J] since set-up
  [[nodiscard]] double kinetic() const noexcept { return kinetic_; }  ///< [J] at present

 private:
  static constexpr double memory = 0.05;  // [s]

  const ArmModel& model_;
  std::vector<double> others_;  // e [N m]
  double gained_ = 0.0, kinetic_ = 0.0;
  bool is_known_ = false;
};

}  // namespace repel
