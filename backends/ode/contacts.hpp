// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Contacts between the links of an arm and obstacles, as contact joints of the Open Dynamics
/// Engine.
#pragma once

#include <ode/ode.h>

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include <repel/base/spatial.hpp>
#include <repel/simulated/contact.hpp>
#include <repel/simulated/simulated_arm.hpp>

namespace repel::ode::detail {

/// The geometries of an arm and of its obstacles. A contact point is a spring and damper,
/// integrated implicitly with the bodies and joints; it never pulls. The same damper acts along the
/// surface, limited by dry friction.
class Contacts {
 public:
  /// @param body one for each link of `model`, at its centre of mass
  /// @param tally gets depths and forces; it and the bodies must outlive this object
  /// @throws SetupError naming a part unsupported by ODE or out of range
  Contacts(dWorldID world, const ArmModel& model, const SimulationOptions& options,
           std::span<const dBodyID> body, std::span<const ContactPart> parts, ContactTally& tally);

  /// Creates a contact joint at every contact point, for one sub-step of `h` [s], and removes those
  /// of the last one.
  void find(double h) noexcept;

  /// Adds up the forces on the last link, once the world has made its sub-step.
  void note_forces() noexcept;

  /// Ends all contacts.
  void forget() noexcept;

 private:
  struct EndSpace {
    void operator()(dxSpace* ended) const { dSpaceDestroy(ended); }
  };
  struct EndGroup {
    void operator()(dxJointGroup* ended) const { dJointGroupDestroy(ended); }
  };

  void touch(dGeomID first, dGeomID second) noexcept;
  void listen(dxJoint* joint, dxBody* link) noexcept;

  dWorldID world_;
  SimulationOptions options_;
  std::unique_ptr<dxSpace, EndSpace> links_, obstacles_;
  std::unique_ptr<dxJointGroup, EndGroup> joints_;
  dSurfaceParameters surface_{};
  ContactTally& tally_;
  dBodyID last_ = nullptr;                // the link that carries the tool
  Pose X_CT_;                             // [m] tool in that body
  Mat3 R_WC_;                             // of that body, at the start of the sub-step
  std::vector<dJointFeedback> feedback_;  // of its contact points
  std::size_t points_ = 0;                // how many of these, in this sub-step
};

}  // namespace repel::ode::detail
