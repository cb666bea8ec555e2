// SPDX-License-Identifier: BSD-3-Clause
/// A PUMA whose operator, readings or loop fail while its tool moves towards a table: how far the
/// tool gets, for faults at several heights, compared with the same motion without a fault.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

#include <repel/cell/arm_port.hpp>
#include <repel/cell/cell.hpp>
#include <repel/runs/setup/describe.hpp>
#include <repel/world/kinematics.hpp>
#ifdef REPEL_RUNS_BULLET
#include <repel/bullet/arm.hpp>
#endif

#ifdef REPEL_RUNS_BULLET

namespace repel::runs {
namespace arm_fault_test {

enum class Fault {
  none,
  silent_operator,
  bad_command,
  not_a_number,  ///< one position, permanently
  all_not_numbers,
  frame_of_zeros,  ///< once
  jump,            ///< of the second joint by 0.1 rad, once
  frozen_frame,
  frozen_encoder,  ///< of the second joint, its rate with it
  huge_rate,       ///< once
};

constexpr const char* names[] = {"none",         "silent operator", "bad command",
                                 "not a number", "all not numbers", "frame of zeros",
                                 "jump",         "frozen frame",    "frozen encoder",
                                 "huge rate"};

/// A simulated arm with corrupted readings from tick `begins` on.
class FaultyArm final : public TorqueDrivenArm {
 public:
  FaultyArm(const ArmModel& model, Fault fault, int begins)
      : arm_(model), fault_(fault), begins_(begins), q_(model.links.size()), v_(q_) {}

  void reset(std::span<const double> q) { arm_.reset(q); }
  void begin_tick(int tick) noexcept {
    since_ = tick - begins_;
    if (since_ >= 0) return;
    arm_.read_positions(q_);
    arm_.read_velocities(v_);
  }
  void set_torques(std::span<const double> torques) noexcept override { arm_.set_torques(torques); }
  void step(double period) noexcept override { arm_.step(period); }
  void read_positions(std::span<double> out) const noexcept override {
    arm_.read_positions(out);
    if (since_ < 0) return;
    const double none = std::numeric_limits<double>::quiet_NaN();
    if (fault_ == Fault::not_a_number) out[1] = none;
    if (fault_ == Fault::all_not_numbers) std::fill(out.begin(), out.end(), none);
    if (fault_ == Fault::frozen_frame) std::copy(q_.begin(), q_.end(), out.begin());
    if (fault_ == Fault::frozen_encoder) out[1] = q_[1];
    if (fault_ == Fault::frame_of_zeros && since_ == 0) std::fill(out.begin(), out.end(), 0.0);
    if (fault_ == Fault::jump && since_ == 0) out[1] += 0.1;
  }
  void read_velocities(std::span<double> out) const noexcept override {
    arm_.read_velocities(out);
    if (since_ < 0) return;
    if (fault_ == Fault::frozen_frame) std::copy(v_.begin(), v_.end(), out.begin());
    if (fault_ == Fault::frozen_encoder) out[1] = 0.0;
    if (fault_ == Fault::frame_of_zeros && since_ == 0) std::fill(out.begin(), out.end(), 0.0);
    if (fault_ == Fault::huge_rate && since_ == 0) out[2] = -1e308;
  }
  void enable() noexcept override { arm_.enable(); }
  void stop() noexcept override { arm_.stop(); }
  void engage_brakes(bool on) noexcept override { arm_.engage_brakes(on); }
  [[nodiscard]] ArmState state() const noexcept override { return arm_.state(); }
  /// The true state.
  [[nodiscard]] const bullet::Arm& truth() const noexcept { return arm_; }

 private:
  bullet::Arm arm_;
  Fault fault_;
  int begins_;
  int since_ = -1;
  std::vector<double> q_, v_;
};

struct Descent {
  double lowest = 1.0;                         ///< [m] of the tool, true value
  double top_speed = 0.0, speed_at_end = 0.0;  ///< [m/s]
  double way = 0.0;                            ///< [m] downward in the 0.25 s after the fault
  int noticed = -1;                            ///< ticks after the fault
  Stop stop = Stop::running;
  Status status = 0;
  double torque = 0.0;  ///< largest, relative to the effort limit
  double change = 0.0;  ///< largest in a tick, relative to it
};

std::string scene_text(double speed, Fault fault, double before) {
  const std::string rate = std::to_string(-1e3 * speed);
  const std::string down = "device: spaceball, linear: 0 0 " + rate + " mm/s";
  std::string after = down;
  if (fault == Fault::silent_operator) after += ", silent: yes";
  return "rate: 400 Hz\nrobot: {urdf: " REPEL_SOURCE
         "/robots/puma560.urdf, start: 0 45 -180 0 -45 0 deg, tool_frame: {position: 0 0 150 mm}}\n"
         "laws: {wall: {range: 20 mm, surface_force: 200 N, damping: 100 N s/m}}\n"
         "tool: [{name: finger, shape: box, size: 24 24 130 mm, position: 0 0 -45 mm}]\n"
         "obstacles: [{name: table, shape: box, size: 0.70 1.10 0.06 m, position: 0.66 -0.15 0.32 "
         "m, "
         "law: wall}]\n"
         "network: [{module: torque_arm}, {module: multiplex}, {module: spaceball}, {module: kbb2, "
         "stiffness: 3 N/mm, damping: 300 N s/m, force_limit: 120 N, angular_stiffness: 30 N "
         "m/rad, "
         "angular_damping: 4 N m s/rad, torque_limit: 15 N m}, {module: obstacle, gain_check: "
         "warning}, {module: puma_kin}, {module: arm_obstacle}, {module: limits}, {module: "
         "puma_joints}]\nscript: [{name: down, duration: " +
         std::to_string(before) + " s, " + down + "}, {name: on, duration: 3 s, " + after + "}]\n";
}

/// [m] True position of the tool frame.
double height(Kinematics& kinematics, const FaultyArm& arm) {
  std::vector<double> q(static_cast<std::size_t>(kinematics.links()));
  arm.truth().read_positions(q);
  kinematics.update(q);
  return kinematics.X_WT().translation().z();
}

/// Down towards the table at `speed`; the fault occurs after the operator has moved for `before`
/// [s]. Without a fault the operator continues to press.
Descent run_down(Fault fault, double speed, double before) {
  scene::Scene parsed = scene::parse(scene_text(speed, fault, before), "scene");
  if (fault == Fault::bad_command) parsed.script.back().rates.linear.z() = std::nan("");
  DescribedScene described = describe(parsed, 400.0);
  described.cell.coprocessor.lock_step = true;
  Cell cell(std::move(described.cell));
  const ArmModel& model = cell.description().arms.front().model;
  const int begins = static_cast<int>(std::lround(400.0 * before));
  FaultyArm arm(model, fault, begins);
  arm.reset(parsed.robot.start);
  ArmPort port(arm, model.links.size());
  network::ScriptedOperator hands(parsed.script);
  Kinematics truth(model);
  Descent run;
  std::vector<double> sent(model.links.size());
  double z = height(truth, arm);
  double at_fault = z;
  for (int k = 0; k < begins + 800; ++k) {
    arm.begin_tick(k);
    const ArmReadings readings = port.read();
    cell.sense({&readings, 1}, (k + 1) * cell.period());
    const network::Command& command = hands.step(cell.X_WT(0).linear(), cell.elapsed());
    const TickRecord& record = *cell.act({&command, 1}).front();
    port.apply(record);
    arm.step(0.0025);
    const double before_step = z;
    z = height(truth, arm);
    run.lowest = std::min(run.lowest, z);
    run.speed_at_end = std::abs(z - before_step) * 400.0;
    run.top_speed = std::max(run.top_speed, run.speed_at_end);
    for (std::size_t i = 0; i < sent.size(); ++i) {
      const double limit = model.links[i].effort_limit;
      run.torque = std::max(run.torque, std::abs(record.torques[i]) / limit);
      if (k > 0) run.change = std::max(run.change, std::abs(record.torques[i] - sent[i]) / limit);
      sent[i] = record.torques[i];
    }
    if (k < begins) {
      at_fault = z;
      continue;
    }
    if (k < begins + 100) run.way = std::max(run.way, at_fault - z);
    if (record.stop != Stop::running && run.noticed < 0) run.noticed = k - begins;
    run.stop = std::max(run.stop, record.stop);
    run.status |= record.status;
  }
  return run;
}

/// One line of the table in docs/faults.md.
void print(const char* name, double speed, const Descent& run) {
  std::printf("  %-16s %.2f m/s: noticed in tick %d, %5.1f mm further, %s\n", name, speed,
              run.noticed, 1e3 * run.way, to_text(run.stop).c_str());
}

TEST(ArmFault, NoFaultBringsThePumaDeeperThanItGoesWithoutOne) {
  for (const double speed : {0.1, 0.2, 0.25}) {
    const Descent without = run_down(Fault::none, speed, 0.2);
    ASSERT_EQ(without.stop, Stop::running) << to_text(without.status);
    for (const double way : {0.02, 0.04, 0.055}) {  // [m] moved when the fault occurs
      for (int i = 1; i < static_cast<int>(std::size(names)); ++i) {
        const Fault fault = static_cast<Fault>(i);
        const Descent run = run_down(fault, speed, way / speed);
        SCOPED_TRACE(std::string(names[i]) + " at " + std::to_string(speed) + " m/s after " +
                     std::to_string(way) + " m: lowest " + std::to_string(1e3 * run.lowest) +
                     " mm, without " + std::to_string(1e3 * without.lowest) + " mm, " +
                     to_text(run.status) + ", " + to_text(run.stop));
        // An operator that recovers continues to press: then the last tenth of a millimetre depends
        // on friction.
        const bool comes_back =
            fault == Fault::frame_of_zeros || fault == Fault::jump || fault == Fault::huge_rate;
        EXPECT_GE(run.lowest, without.lowest - (comes_back ? 1.5e-3 : 1e-5));
        EXPECT_LE(run.noticed, fault == Fault::silent_operator ? 8 : 2);
        EXPECT_GE(run.noticed, 0);
        if (way < 0.03) print(names[i], speed, run);
        EXPECT_LE(run.torque, 1.0);
        EXPECT_LE(run.change, 0.5 + 1e-9);
        EXPECT_LE(run.top_speed, 1.5 * 0.25);
        if (!comes_back) {
          EXPECT_LE(run.speed_at_end, 1e-3);
        }
      }
    }
  }
}

}  // namespace arm_fault_test
}  // namespace repel::runs

#endif
