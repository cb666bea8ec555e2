// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// An arm and what it can touch, as a model of MuJoCo.
#pragma once

#include <mujoco/mujoco.h>

#include <memory>
#include <span>

#include <repel/simulated/contact.hpp>
#include <repel/simulated/simulated_arm.hpp>

namespace repel::mujoco::detail {

struct EndModel {
  void operator()(mjModel* ended) const { mj_deleteModel(ended); }
};
struct EndData {
  void operator()(mjData* ended) const { mj_deleteData(ended); }
};
using Model = std::unique_ptr<mjModel, EndModel>;
using Data = std::unique_ptr<mjData, EndData>;

/// The links of `model` are the bodies 1, 2, ..., with one degree of freedom each, without damping
/// and stops. The parts are geoms; only those of links touch only those of the world.
/// @throws SetupError naming a part that MuJoCo cannot have
[[nodiscard]] Model compiled(const ArmModel& model, const SimulationOptions& options,
                             std::span<const ContactPart> parts);

}  // namespace repel::mujoco::detail
