/// @file
/// Where the links of an arm touch obstacles, as contact joints of the Open Dynamics Engine.
#pragma once

#include <ode/ode.h>

#include <memory>
#include <span>

#include <repel/world/contact.hpp>
#include <repel/world/simulated_arm.hpp>

namespace repel::ode::detail {

/// The geometries of an arm and of its obstacles. A point of contact is a spring and damper taken
/// implicitly, as bodies and joints are; it never pulls, and the same damper slides with dry
/// friction along the surface.
class Contacts {
 public:
  /// @param body one for each link of `model`, at its centre of mass; they outlive this
  /// @throws SetupError naming the part that ODE cannot collide or that is out of range
  Contacts(dWorldID world, const ArmModel& model, const SimulationOptions& options,
           std::span<const dBodyID> body, std::span<const ContactPart> parts);

  /// Puts a joint at every point of contact, for one sub-step of `h` [s], in place of those of the
  /// last one.
  void find(double h) noexcept;

  /// Ends a step: counts it if one of its sub-steps had a contact.
  void end_step() noexcept;

  /// Nothing was touched yet.
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
