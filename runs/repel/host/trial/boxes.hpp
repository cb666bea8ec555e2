// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A synthetic tick with the load of a scene: the paper's number of pairs, all within range.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include <repel/loop/record.hpp>
#include <repel/schedule/coprocessor.hpp>
#include <repel/world/world.hpp>

namespace repel::host {

/// Four boxes on a tool that moves among eight boxes around it; all 32 pairs stay within range.
class Boxes {
 public:
  Boxes() : tool_(world_.add_body("tool")), coprocessor_(build(world_, tool_), {}) {}
  Boxes(const Boxes&) = delete;
  Boxes& operator=(const Boxes&) = delete;

  /// Moves the tool to its position at `time` [s] and evaluates every pair.
  const TickRecord& tick(double time) noexcept {
    Pose X = Pose::Identity();
    X.translation() = 0.05 * Vec3(std::sin(time), std::sin(1.3 * time), std::sin(1.7 * time));
    record_.tick = ++world_.motion().tick;
    record_.time = time;
    world_.place(tool_, X, {});
    const PairForces& forces = coprocessor_.exchange();
    record_.virtual_force = forces.on_body[static_cast<std::size_t>(tool_.index)];
    record_.pairs = forces.totals;
    return record_;
  }
  /// Exercises the code and data of a tick without changing any state, to keep the caches warm.
  void rehearse() noexcept { coprocessor_.rehearse(); }

  [[nodiscard]] int pairs() const noexcept { return static_cast<int>(world_.pairs().size()); }

 private:
  static const World& build(World& world, BodyId tool) {
    constexpr int parts = 4;
    constexpr int obstacles = 8;
    const ForceLaw law{.range = 1.0};
    for (int i = 0; i < parts; ++i) {
      Pose X = Pose::Identity();
      X.translation() = Vec3(i % 2 == 0 ? 0.04 : -0.04, i < 2 ? 0.04 : -0.04, 0.0);
      world.add_part(tool, "part", Shape::box({0.03, 0.04, 0.05}), X);
    }
    for (int i = 0; i < obstacles; ++i) {
      const Pose turn(Eigen::AngleAxisd(2.0 * M_PI * i / obstacles, Vec3::UnitZ()));
      Pose X = turn * Eigen::Translation3d(0.4, 0.0, 0.02 * i);
      X.rotate(Eigen::AngleAxisd(0.3 * i, Vec3(1.0, 2.0, 3.0).normalized()));
      const PartId wall = world.add_part(World::fixed, "wall", Shape::box({0.05, 0.1, 0.07}), X);
      for (std::int32_t part = 0; part < parts; ++part) world.add_pair({part}, wall, law);
    }
    return world;
  }

  World world_;
  BodyId tool_;
  Coprocessor coprocessor_;
  TickRecord record_;
};

}  // namespace repel::host
