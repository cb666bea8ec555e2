// SPDX-License-Identifier: BSD-3-Clause
#include <repel/runs/arms/arm_backend.hpp>

#include <algorithm>

#include <repel/base/setup_error.hpp>
#include <repel/ideal/arm.hpp>
#include <repel/robots/dynamics.hpp>
#include <repel/simulated/brake_torque.hpp>
#ifdef REPEL_RUNS_BULLET
#include <repel/bullet/arm.hpp>
#endif
#ifdef REPEL_RUNS_MUJOCO
#include <repel/mujoco/arm.hpp>
#endif
#ifdef REPEL_RUNS_ODE
#include <repel/ode/arm.hpp>
#endif

namespace repel::runs {
namespace {

using ArmPointer = std::unique_ptr<TorqueDrivenArm>;

template <class Arm>
ArmPointer at_start(std::unique_ptr<Arm> arm, std::span<const double> start) {
  arm->reset(start);
  return arm;
}

/// Joints of an arm without dynamics of its own: motor inertia and friction, and a brake that holds
/// the heaviest pose.
ArmPointer make_ideal(const ArmModel& model, std::span<const double> start, double watchdog,
                      std::span<const ContactPart> /*parts*/) {
  std::vector<IdealJoint> joints;
  for (const ArmLink& link : model.links) {
    joints.push_back({std::max(least_ideal_inertia, link.rotor_inertia),
                      std::max(1.0, link.viscous_friction),
                      brake_torque(model, static_cast<int>(joints.size()))});
  }
  return at_start(std::make_unique<IdealArm>(joints, IdealOptions{.watchdog = watchdog}), start);
}

ArmPointer make_reference(const ArmModel& model, std::span<const double> start, double watchdog,
                          std::span<const ContactPart> /*parts*/) {
  return at_start(std::make_unique<ReferenceArm>(model, ReferenceOptions{.watchdog = watchdog}),
                  start);
}

#if defined(REPEL_RUNS_BULLET) || defined(REPEL_RUNS_MUJOCO) || defined(REPEL_RUNS_ODE)
template <class Arm>
ArmPointer make_simulated(const ArmModel& model, std::span<const double> start, double watchdog,
                          std::span<const ContactPart> parts) {
  SimulationOptions options;
  options.watchdog = watchdog;
  return at_start(std::make_unique<Arm>(model, options, parts), start);
}
#endif

#if !defined(REPEL_RUNS_BULLET) || !defined(REPEL_RUNS_MUJOCO) || !defined(REPEL_RUNS_ODE)
template <const char* remedy>
ArmPointer refuse(const ArmModel& /*model*/, std::span<const double> /*start*/, double /*watchdog*/,
                  std::span<const ContactPart> /*parts*/) {
  throw SetupError(remedy);
}
#endif

#ifdef REPEL_RUNS_BULLET
constexpr auto make_bullet = &make_simulated<bullet::Arm>;
#else
constexpr char no_bullet[] =
    "backend bullet is not built in; to have it: apt-get install libbullet-dev";
constexpr auto make_bullet = &refuse<no_bullet>;
#endif
#ifdef REPEL_RUNS_ODE
constexpr auto make_ode = &make_simulated<ode::Arm>;
#else
constexpr char no_ode[] = "backend ode is not built in; to have it: apt-get install libode-dev";
constexpr auto make_ode = &refuse<no_ode>;
#endif
#ifdef REPEL_RUNS_MUJOCO
constexpr auto make_mujoco = &make_simulated<mujoco::Arm>;
#else
constexpr char no_mujoco[] =
    "backend mujoco is not built in; to have it: apt-get install libmujoco-dev";
constexpr auto make_mujoco = &refuse<no_mujoco>;
#endif

constexpr ArmBackend backends[] = {
    {.name = "bullet", .has_gravity = true, .has_contact = true, .make = make_bullet},
    {.name = "ode", .has_gravity = true, .has_contact = true, .make = make_ode},
    {.name = "mujoco", .has_gravity = true, .has_contact = true, .make = make_mujoco},
    {.name = "reference", .has_gravity = true, .has_contact = false, .make = &make_reference},
    {.name = "ideal", .has_gravity = false, .has_contact = false, .make = &make_ideal},
};

}  // namespace

std::span<const ArmBackend> arm_backends() {
  return backends;
}

const ArmBackend& arm_backend(const std::string& name) {
  std::string names;
  for (const ArmBackend& backend : backends) {
    if (name == backend.name) return backend;
    names += (names.empty() ? "" : ", ") + std::string(backend.name);
  }
  throw SetupError("backend '" + name + "'; allowed: " + names);
}

}  // namespace repel::runs
