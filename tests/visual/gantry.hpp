// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A cell as a program of one's own describes it: no file, no robot library.
#pragma once

#include <array>
#include <chrono>
#include <memory>
#include <span>
#include <utility>

#include <repel/visual/live_view.hpp>

namespace repel::test {

/// Three rails along x, y and z, without weight.
struct Gantry final : ArmKinematics {
  void update(std::span<const double> q) noexcept override { p = {q[0], q[1], q[2]}; }
  [[nodiscard]] Pose X_WT() const noexcept override { return X_WL(2); }
  [[nodiscard]] Pose X_WL(int link) const noexcept override {
    return Pose(Eigen::Translation3d(p.x(), link > 0 ? p.y() : 0.0, link > 1 ? p.z() : 0.0));
  }
  void tool_jacobian(JacobianRef J) const noexcept override { J.setIdentity(); }
  void gravity_torques(std::span<double> out) noexcept override { out[0] = out[1] = out[2] = 0.0; }
  Vec3 p{0, 0, 0};
};

/// A ball on a gantry, a wall whose face is 0.2 m in front of it, and a post that moves.
inline CellDescription gantry_cell() {
  CellDescription description{.rate_hz = 1000.0};
  ArmDescription& arm = description.arms.emplace_back();
  ArmLink rail{.type = JointType::prismatic, .lower = -1.0, .upper = 1.0};
  rail.viscous_friction = 300.0;
  rail.rotor_inertia = 4.0;
  arm.model.links = {rail, rail, rail};
  arm.kinematics = std::make_unique<Gantry>();
  arm.parts.push_back({"ball", Shape::sphere(0.05)});
  const Pose X_WP(Eigen::Translation3d(0.35, 0.0, 0.0));
  description.obstacles.push_back({"wall", Shape::box({0.1, 1.0, 1.0}), X_WP});
  ObstacleDescription post{"post", Shape::box({0.05, 0.05, 0.5}),
                           Pose(Eigen::Translation3d(0.0, 0.7, 0.0))};
  post.motion = ReciprocatingMotion{};
  description.obstacles.push_back(std::move(post));
  return description;
}

/// The loop of such a program, by a clock of its own.
struct GantryLoop {
  /// One tick with the command of the page that drives, else with `own`.
  const TickRecord& step(visual::LiveView& view) noexcept {
    const network::Command* const page = view.command();
    is_driven = page != nullptr;
    now += cell.period();
    const TickRecord& tick = cell.step({q, v}, is_driven ? *page : own, now);
    for (std::size_t i = 0; i < 3; ++i) {
      v[i] += 0.001 / 4.0 * (tick.torques[i] - 300.0 * v[i]);
      q[i] += 0.001 * v[i];
    }
    view.show(tick, {std::chrono::microseconds(20), std::chrono::microseconds(100)});
    return tick;
  }

  Cell cell{gantry_cell()};
  std::array<double, 3> q{};  // [m]
  std::array<double, 3> v{};  // [m/s]
  network::Command own;
  bool is_driven = false;
  std::chrono::nanoseconds now{0};
};

/// On a free local port.
inline visual::ViewOptions free_port(bool pages_drive = true) {
  visual::ViewOptions options{.pages_drive = pages_drive};
  options.server.port = 0;
  return options;
}

}  // namespace repel::test
