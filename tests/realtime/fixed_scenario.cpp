// SPDX-License-Identifier: BSD-3-Clause
// A deterministic sequence of ticks for the instruction count of instructions.sh: the gripper of
// four parts among the eight obstacles of scenes/anderson_4x8.yaml, pressed on the table, slid into
// the corner, through the membrane and against the box. Each tick writes one profile. Without
// valgrind it only runs.
#include <valgrind/callgrind.h>

#include <cstdio>
#include <cstring>

#include "loop/slider.hpp"

namespace repel::test {
namespace {

#if defined(__clang__)
constexpr const char* compiler = "clang";
constexpr int version = __clang_major__;
#else
constexpr const char* compiler = "g++";
constexpr int version = __GNUC__;
#endif

constexpr std::chrono::nanoseconds period{2500000};

/// Three sliders with the tool pointing down; it tilts as it moves, so that no pair is static.
struct LeaningKinematics : SliderKinematics {
  void update(std::span<const double> q) noexcept override {
    SliderKinematics::update(q);
    down_and_sideways =
        Eigen::AngleAxisd(std::acos(-1.0) + lean * (q[1] + 0.15), Vec3::UnitX()).toRotationMatrix();
    const Eigen::AngleAxisd forwards(lean * (q[0] - 0.6), Vec3::UnitY());
    pose.linear() = down_and_sideways * forwards;
  }
  void tool_jacobian(JacobianRef J) const noexcept override {
    SliderKinematics::tool_jacobian(J);
    J.col(0).tail<3>() = lean * down_and_sideways.col(1);
    J.col(1).tail<3>() = lean * Vec3::UnitX();
  }

  static constexpr double lean = 0.3;  // [rad/m]
  Mat3 down_and_sideways = Mat3::Identity();
};

/// Full sizes [m], as in the scene file.
Shape box(double x, double y, double z) {
  return Shape::box(0.5 * Vec3(x, y, z));
}

Pose at(double x, double y, double z) {
  Pose X = Pose::Identity();
  X.translation() = Vec3(x, y, z);
  return X;
}

void add_gripper_among_obstacles(CellDescription& cell) {
  const ForceLaw wall{.range = 0.02, .surface_force = 200.0, .damping = 100.0};
  const ForceLaw membrane{
      .range = 0.015, .surface_force = 60.0, .damping = 20.0, .ceiling = 12.0, .passable = true};
  const Shape finger = box(0.024, 0.022, 0.13);
  cell.arms.front().parts = {{"mount", Shape::cylinder(0.032, 0.045), at(0, 0, -0.105)},
                             {"palm", box(0.06, 0.12, 0.05), at(0, 0, -0.085)},
                             {"left finger", finger, at(0, 0.049, -0.045)},
                             {"right finger", finger, at(0, -0.049, -0.045)}};
  const auto obstacle = [&](const char* name, const Shape& shape, const Pose& X,
                            const ForceLaw& law) {
    cell.obstacles.push_back({name, shape, X, law});
  };
  obstacle("table", box(0.7, 1.1, 0.06), at(0.66, -0.15, 0.325), wall);
  obstacle("corner floor", box(0.25, 0.18, 0.03), at(0.665, 0.03, 0.355), wall);
  obstacle("corner side", box(0.25, 0.03, 0.15), at(0.665, 0.105, 0.42), wall);
  obstacle("corner end", box(0.03, 0.18, 0.15), at(0.775, 0.03, 0.42), wall);
  obstacle("box", box(0.12, 0.2, 0.18), at(0.8, -0.38, 0.445), wall);
  obstacle("cylinder", Shape::cylinder(0.04, 0.1), at(0.75, -0.14, 0.455), wall);
  obstacle("post", Shape::capsule(0.018, 0.125), at(0.46, -0.25, 0.478), wall);
  obstacle("membrane", box(0.16, 0.2, 0.004), at(0.62, -0.36, 0.438), membrane);
}

network::Script way() {
  network::Script script;
  const auto go = [&](double seconds, double x, double y, double z) {
    network::Phase phase;
    phase.duration = seconds;
    phase.rates.linear = Vec3(x, y, z);
    script.push_back(phase);
  };
  go(0.40, 0.05, 0.0, -0.25);    // to the table
  go(0.25, -0.2, 0.0, -0.1);     // press and slide
  go(0.20, 0.0, 0.15, 0.2);      // up
  go(0.60, 0.15, 0.2, -0.06);    // to the corner and into it
  go(0.30, -0.15, -0.15, 0.15);  // out again
  go(0.80, -0.02, -0.25, 0.05);  // to the membrane
  go(0.50, 0.0, 0.0, -0.25);     // through it
  go(0.60, 0.25, 0.0, 0.0);      // into the box
  return script;
}

int run() {
  CellDescription description;
  description.gain_check = network::GainCheck::warning;
  description.coprocessor.budget.wall = std::chrono::seconds(1);  // so that the clock is read
  ArmDescription& sliders = description.arms.emplace_back();
  sliders.model = slider_model(1000.0);
  sliders.kinematics = std::make_unique<LeaningKinematics>();
  sliders.start = {0.6, -0.15, 0.45};
  sliders.network = sliders_network({.stiffness = 3000.0, .damping = 300.0, .force_limit = 120.0});
  add_gripper_among_obstacles(description);
  Cell cell(std::move(description));
  SliderArm arm;
  arm.q = {0.6, -0.15, 0.45};
  ArmPort port(arm, 3);
  network::ScriptedOperator hands(way());
  double peak = 0.0;
  std::int64_t evaluated = 0;
  Status status = 0;
  constexpr int ticks = 1460;
  CALLGRIND_START_INSTRUMENTATION;
  for (int k = 1; k <= ticks; ++k) {
    CALLGRIND_ZERO_STATS;
    const ArmReadings readings = port.read();
    cell.sense({&readings, 1}, k * period);
    const network::Command& command = hands.step(cell.X_WT(0).linear(), cell.elapsed());
    const TickRecord& record = *cell.act({&command, 1}).front();
    port.apply(record);
    CALLGRIND_DUMP_STATS;
    arm.step(1e-9 * static_cast<double>(period.count()));
    peak = std::max(peak, record.virtual_force.force.norm());
    evaluated += record.pairs.evaluated;
    status |= record.status;
  }
  CALLGRIND_STOP_INSTRUMENTATION;
  std::printf("%d ticks, %.2f pairs evaluated in each, peak force %.1f N\n", ticks,
              static_cast<double>(evaluated) / ticks, peak);
  const Status faults = status & repel::status::failsafe;
  const bool as_ever = faults == 0 && peak > 100.0 && peak < 300.0 && evaluated > 2 * ticks;
  return as_ever ? 0 : 1;
}

}  // namespace
}  // namespace repel::test

int main(int argc, char** argv) {
  if (argc == 2 && std::strcmp(argv[1], "--compiler") == 0) {
    std::printf("%s %d\n", repel::test::compiler, repel::test::version);
    return 0;
  }
  if (argc > 1) {
    std::fputs("fixed_scenario [--compiler]: runs its ticks, or names what it was built by\n",
               stderr);
    return std::strcmp(argv[1], "--help") == 0 ? 0 : 2;
  }
  return repel::test::run();
}
