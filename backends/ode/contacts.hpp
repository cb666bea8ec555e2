/// @file
/// Contacts between the links of an arm and obstacles, as contact joints of the Open Dynamics
/// Engine.
#pragma once

#include <ode/ode.h>

#include <memory>
#include <span>

#include <repel/world/contact.hpp>
#include <repel/world/simulated_arm.hpp>

namespace repel::ode::detail {

/// The geometries of an arm and of its obstacles. A contact point is a spring and damper,
/// integrated implicitly with the bodies and joints; it never pulls. The same damper acts along the
/// surface, limited by dry friction.
class Contacts {
 public:
  /// @param body one for each link of `model`, at its centre of mass; they must outlive this object
  /// @throws SetupError naming the part that ODE does not support or that is out of range
  Contacts(dWorldID world, const ArmModel& model, const SimulationOptions& options,
           std::span<const dBodyID> body, std::span<const ContactPart> parts);

  /// Creates a contact joint at every contact point, for one sub-step of `h` [s], and removes those
  /// of the last one.
  void find(double h) noexcept;

  /// Ends a step: counts it if any of its sub-steps had a contact.
  void end_step() noexcept;

  /// Clears contacts and report.
  void forget() noexcept;

  [[nodiscard]] ContactReport report() const noexcept { return report_; }

 private:
  struct EndSpace {
    void operator()(dxSpace* ended) const { dSpaceDestroy(ended); }
  };
  struct EndGroup {
    void operator()(dxJointGroup* ended) const { dJointGroupDestroy(ended); }
  };

  void touch(dGeomID first, dGeomID second) noexcept;

  dWorldID world_;
  SimulationOptions options_;
  std::unique_ptr<dxSpace, EndSpace> links_, obstacles_;
  std::unique_ptr<dxJointGroup, EndGroup> joints_;
  dSurfaceParameters surface_{};
  ContactReport report_;
  bool touching_ = false;  // in this step
};

}  // namespace repel::ode::detail
