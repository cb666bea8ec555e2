// SPDX-License-Identifier: BSD-3-Clause
// Your own program with the live view: pages look on, and drive a gantry towards a wall.
//     05_own_view [TICKS [PORT]]
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <thread>

#include <repel/visual/live_view.hpp>

using namespace repel;
using Clock = std::chrono::steady_clock;

struct Gantry final : ArmKinematics {  // three rails along x, y and z, 4 kg on each
  void update(std::span<const double> q) noexcept override { p = {q[0], q[1], q[2]}; }
  Pose X_WT() const noexcept override { return Pose(Eigen::Translation3d(p)); }
  void tool_jacobian(JacobianRef J) const noexcept override { J.setIdentity(); }
  void gravity_torques(std::span<double> out) noexcept override { out[2] = 4.0 * 9.81; }  // [N]
  Vec3 p{0, 0, 0};
};

CellDescription gantry() {
  CellDescription description{.rate_hz = 1000.0};
  ArmDescription& arm = description.arms.emplace_back();
  ArmLink rail{.type = JointType::prismatic, .lower = -1.0, .upper = 1.0};  // [m]
  rail.viscous_friction = 300.0;                                            // [N s/m]
  rail.rotor_inertia = 4.0;                                                 // [kg]
  arm.model.links = {rail, rail, rail};
  arm.kinematics = std::make_unique<Gantry>();
  arm.parts.push_back({"ball", Shape::sphere(0.05)});
  const Pose X_WP(Eigen::Translation3d(0.35, 0.0, 0.0));
  description.obstacles.push_back({"wall", Shape::box({0.1, 0.3, 0.3}), X_WP});
  return description;
}

int main(int argc, char** argv) try {
  const long ticks = argc > 1 ? std::atol(argv[1]) : std::numeric_limits<long>::max();
  Cell cell(gantry());
  visual::ViewOptions options{.pages_drive = true};
  if (argc > 2) options.server.port = static_cast<std::uint16_t>(std::atoi(argv[2]));
  visual::LiveView view(cell, visual::scene_info_of(cell, "gantry"), options);
  std::printf("Live view: %s\n", view.url().c_str());

  double q[3] = {}, v[3] = {};             // what your drives report [m], [m/s]
  network::Command own;                    // your own operator, while no page drives:
  own.hand.ball.linear = {0.1, 0.0, 0.0};  // 100 mm/s towards the wall
  Clock::time_point due = Clock::now();
  for (long k = 0; k < ticks; ++k, due += cell.period()) {
    std::this_thread::sleep_until(due);
    const Clock::time_point begin = Clock::now();
    const network::Command* const page = view.command();
    const TickRecord& tick =
        cell.step({q, v}, page != nullptr ? *page : own, due.time_since_epoch());
    for (int i = 0; i < 3; ++i) {  // in place of your drives: 4 kg, friction, weight
      v[i] += 0.001 / 4.0 * (tick.torques[i] - 300.0 * v[i] - (i == 2 ? 4.0 * 9.81 : 0.0));
      q[i] += 0.001 * v[i];
    }
    view.show(tick, {.late = begin - due, .compute = Clock::now() - begin});
    if (k % 1000 != 999) continue;
    std::printf("x %.3f m, wall %.1f N, %s\n", q[0], tick.pairs.peak_force,
                page == nullptr          ? "the program drives"
                : page->silent_for > 0.0 ? "the page is silent"
                                         : "a page drives");
  }
} catch (const SetupError& error) {
  std::fprintf(stderr, "05_own_view: %s\n", error.what());
  return 1;
}
