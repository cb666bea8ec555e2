// SPDX-License-Identifier: BSD-3-Clause
// Your own arm, controlled by the library at 1 kHz: a gantry whose tool is driven into a wall.
#include <cstdio>
#include <thread>

#include <repel/cell/cell.hpp>

using namespace repel;

struct Gantry final : ArmKinematics {  // three rails along x, y and z, 4 kg on each
  void update(std::span<const double> q) noexcept override { p = {q[0], q[1], q[2]}; }
  Pose X_WT() const noexcept override { return Pose(Eigen::Translation3d(p)); }
  void tool_jacobian(JacobianRef J) const noexcept override { J.setIdentity(); }
  void gravity_torques(std::span<double> out) noexcept override { out[2] = 4.0 * 9.81; }  // [N]
  Vec3 p{0, 0, 0};
};

int main() {
  CellDescription description{.rate_hz = 1000.0};
  ArmDescription& arm = description.arms.emplace_back();
  ArmLink rail{.type = JointType::prismatic, .lower = -1.0, .upper = 1.0};  // [m]
  rail.viscous_friction = 300.0;                                            // [N s/m]
  rail.rotor_inertia = 4.0;                                                 // [kg]
  arm.model.links = {rail, rail, rail};
  arm.kinematics = std::make_unique<Gantry>();
  arm.parts.push_back({"ball", Shape::sphere(0.05)});
  const Pose X_WP(Eigen::Translation3d(0.35, 0.0, 0.0));
  description.obstacles.push_back({"wall", Shape::box({0.1, 1.0, 1.0}), X_WP});
  Cell cell(std::move(description));  // every check runs here; throws SetupError
  std::jthread controller([&] {
    double q[3] = {}, v[3] = {};               // what your drives report [m], [m/s]
    network::Command hands;                    // and your master device:
    hands.hand.ball.linear = {0.1, 0.0, 0.0};  // 100 mm/s towards the wall
    auto due = std::chrono::steady_clock::now();
    for (int k = 0; k <= 4000; ++k, due += cell.period()) {
      std::this_thread::sleep_until(due);
      const TickRecord& tick = cell.step({q, v}, hands, due.time_since_epoch());
      for (int i = 0; i < 3; ++i) {  // in place of your drives: 4 kg, friction, weight
        v[i] += 0.001 / 4.0 * (tick.torques[i] - 300.0 * v[i] - (i == 2 ? 4.0 * 9.81 : 0.0));
        q[i] += 0.001 * v[i];
      }
      if (k % 500 == 0) std::printf("x %.3f m, wall %.1f N\n", q[0], tick.pairs.peak_force);
    }
  });
}
