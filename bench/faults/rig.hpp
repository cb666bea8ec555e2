// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// An arm before a wall, and the hand that leads it.
#pragma once

#include <memory>
#include <vector>

#include <repel/cell/description.hpp>
#include <repel/network/modules/limits.hpp>

#include "plant.hpp"

namespace repel::faults {

enum class Arm { rails, puma };
enum class Situation { on_the_way, pressing };

inline const char* to_text(Arm arm) {
  return arm == Arm::rails ? "rails" : "puma";
}
inline const char* to_text(Situation situation) {
  return situation == Situation::pressing ? "pressing" : "on the way";
}
inline const char* to_text(HoldKind hold) {
  return hold == HoldKind::hard ? "hard" : "soft";
}

/// One way to meet a fault.
struct Setting {
  Arm arm = Arm::rails;
  Situation situation = Situation::on_the_way;
  HoldKind hold = HoldKind::hard;
  double rate = 400.0;     ///< [Hz]
  std::uint64_t seed = 1;  ///< of noise, and of where a fault begins on the way
  bool has_brakes = true;
};

/// What a run is made of; a sound run changes some of it.
struct Rig {
  ArmModel model;             ///< what the cell knows
  ArmModel plant;             ///< what the arm is
  std::vector<double> start;  ///< [rad] or [m]
  std::vector<Points> parts;
  Pose X_WB = Pose::Identity();  ///< of the middle of the wall, a box
  Vec3 half{2, 2, 2};            ///< [m]
  Vec3 inward{1, 0, 0};          ///< unit, into the wall
  std::size_t shoulder = 0, wrist = 0;
  network::JointLimits limits{};
  std::vector<network::JointRange> ranges;
  TeleoperatorOptions options;
  std::size_t late = 0;                      ///< [ticks] by which the drive is late
  double push = 1e4;                         ///< [N] greatest force of the hand
  void (*sensed)(Exchange&) = nullptr;       ///< what honest sensors make of the truth
  void (*led)(Exchange&, double) = nullptr;  ///< the hand at a time [s]; without: into the wall
};

/// @throws SetupError if the model of the arm cannot be read
[[nodiscard]] Rig make_rig(Arm arm, HoldKind hold);

/// The cell of a rig. @param kinematics of its arm
[[nodiscard]] CellDescription described(const Rig& rig, const Setting& setting,
                                        std::unique_ptr<ArmKinematics> kinematics);

/// An arm without a fault that differs from its model, within what the loop must bear.
struct Sound {
  const char* name;
  void (*change)(Rig&);
};

[[nodiscard]] std::span<const Sound> all_sound();

}  // namespace repel::faults
