// SPDX-License-Identifier: BSD-3-Clause
#include <repel/runs/operator/part_steps.hpp>

#include <algorithm>

#include <repel/cell/layout.hpp>
#include <repel/reduction/separation.hpp>

namespace repel::runs {

PartSteps::PartSteps(const scene::Scene& scene, Cell& cell) : cell_(cell) {
  for (std::size_t arm = 0; arm < cell.arms(); ++arm) {
    const scene::ArmSetup& setup = scene.arm_setup(arm);
    for (const scene::PartStep& step : setup.steps) steps_.push_back({arm, step});
    lengths_.push_back(static_cast<std::int32_t>(setup.script.size()));
    phases_.push_back(-1);
  }
  for (const scene::LoosePart& part : scene.loose) ranges_.push_back(part.law.range);
}

void PartSteps::follow(std::size_t arm, std::int32_t phase) noexcept {
  const std::int32_t last = phases_[arm];
  // What no phase is of this script comes from a station that is false.
  if (phase <= last || phase > lengths_[arm]) return;
  phases_[arm] = phase;
  if (phase == lengths_[arm]) return;
  for (PartStepResult& result : steps_) {
    const auto of_step = static_cast<std::int32_t>(result.step.phase);
    if (result.arm == arm && of_step > last && of_step <= phase) make(result);
  }
}

void PartSteps::make(PartStepResult& result) noexcept {
  using What = scene::PartStep::What;
  World& world = cell_.world();
  const scene::PartStep& step = result.step;
  const PartId id = cell_.loose()[step.part];
  const LooseDescription& part = cell_.description().loose[step.part];
  switch (step.what) {
    case What::spawn:
      result.was_made = world.add(id, part.X_WP, step.over);
      break;
    case What::grip:
      result.distance = distance_to_tool(result.arm, id);
      result.was_made = result.distance <= ranges_[step.part] &&
                        world.attach(id, cell_.layout(result.arm).tool, step.over);
      break;
    case What::release:
      result.was_made = world.release(id, step.over);
      break;
    case What::remove:
      result.was_made = world.remove(id, step.over);
      break;
  }
  result.was_refused = !result.was_made;
}

double PartSteps::distance_to_tool(std::size_t arm, PartId part) const noexcept {
  const World& world = cell_.world();
  const auto pose_of = [&](const Part& each) {
    return composed(world.motion().bodies[static_cast<std::size_t>(each.body.index)].X_WB,
                    each.X_BP);
  };
  const Part& gripped = world.part(part);
  const Pose X_WP = pose_of(gripped);
  double least = std::numeric_limits<double>::infinity();
  for (const PartId id : cell_.layout(arm).parts) {
    const Part& of_arm = world.part(id);
    if (of_arm.body != cell_.layout(arm).tool) continue;
    least = std::min(least,
                     separation(of_arm.shape, pose_of(of_arm), gripped.shape, X_WP, {}).distance);
  }
  return least;
}

}  // namespace repel::runs
