// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The two sides of a divided scene, in step: the real ones, but for the clock.
#pragma once

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include <repel/runs/arms/arm_backend.hpp>
#include <repel/runs/engine/driven_cell.hpp>
#include <repel/runs/setup/prepared_run.hpp>
#include <repel/runs/station/station_side.hpp>
#include <repel/scene/scene.hpp>

#include "network/remote/relay.hpp"

namespace repel::test {

inline constexpr double tick = 0.0025;  ///< [s]

inline runs::RunOptions in_step() {
  runs::RunOptions options;
  options.fast = true;
  return options;
}

/// The robot's side.
struct Site {
  network::RemoteLink link;
  std::unique_ptr<runs::PreparedRun> prepared;
  std::unique_ptr<runs::DrivenCell> driven;
  TickRecord last;

  Site(const scene::Scene& scene, std::uint64_t session) : link({.session = session}) {
    const runs::RunOptions options = in_step();
    prepared = runs::prepare(scene, options, nullptr, &link);
    const ArmDescription& arm = prepared->cell.description().arms.front();
    std::vector<std::unique_ptr<TorqueDrivenArm>> arms;
    arms.push_back(runs::arm_backend("bullet").make(arm.model, arm.start, 0.1, {}));
    std::vector<runs::OperatorInput> operators;
    operators.emplace_back(network::Script());
    driven = std::make_unique<runs::DrivenCell>(prepared->cell, prepared->scene, std::move(arms),
                                                std::move(operators), &link);
  }
  void step(double now) {
    last = *driven->tick(at(now)).front();
    driven->move_arms(tick, 1);
  }
};

/// The operator's side of the same scene.
struct Station {
  network::RemoteLink link;
  runs::StationSide side;

  Station(const scene::Scene& scene, std::uint64_t session)
      : link({.session = session}), side(scene, in_step(), link, nullptr) {}
};

}  // namespace repel::test
