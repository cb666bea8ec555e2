// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Positions of the held joints of a robot: those beside its arm.
#pragma once

#include <map>
#include <string>

#include <urdf_model/model.h>

#include <repel/base/types.hpp>
#include <repel/robots/robot.hpp>

#include "chain_choice.hpp"
#include "urdf_document.hpp"

namespace repel::detail {

/// Decides for each joint whether it moves and, if not, where it is held.
class HeldJoints {
 public:
  /// All arguments must outlive it.
  HeldJoints(const UrdfDocument& document, const urdf::ModelInterface& model,
             const ChainChoice& chain)
      : document_(document), model_(model), chain_(chain) {}

  /// Whether `joint` is one of the arm.
  /// @throws SetupError if it is in the chain and cannot be a joint of a serial arm
  [[nodiscard]] bool moves(const urdf::Joint& joint) const;

  /// Position of the held `joint`, and the reason.
  /// @throws SetupError if its value is out of range, or it mimics a joint that moves
  [[nodiscard]] const HeldJoint& held(const urdf::Joint& joint);

  /// The pose of the child of `joint` at `position` [rad] or [m], in the frame of the joint.
  /// @throws SetupError if its axis has no direction
  [[nodiscard]] Pose displacement(const urdf::Joint& joint, double position) const;

 private:
  [[nodiscard]] bool is_of_the_arm(const urdf::Joint& joint) const;
  [[nodiscard]] bool follows_a_moving_one(const urdf::Joint& joint) const;
  [[nodiscard]] HeldJoint as_chosen(const urdf::Joint& joint, const Hold& hold) const;
  [[nodiscard]] HeldJoint near_zero(const urdf::Joint& joint) const;
  [[nodiscard]] HeldJoint following(const urdf::Joint& joint, double leader) const;
  [[nodiscard]] HeldJoint within_limits(const urdf::Joint& joint, double wanted,
                                        const std::string& reason) const;
  [[noreturn]] void refuse_follower(const urdf::Joint& joint) const;

  const UrdfDocument& document_;
  const urdf::ModelInterface& model_;
  const ChainChoice& chain_;
  std::map<std::string, HeldJoint> held_;
};

/// The axis of `joint`, of length 1.
/// @throws SetupError if it has no direction
[[nodiscard]] Vec3 axis_of(const urdf::Joint& joint, const UrdfDocument& document);

}  // namespace repel::detail
