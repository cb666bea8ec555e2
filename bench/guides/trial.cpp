// SPDX-License-Identifier: BSD-3-Clause
#include "trial.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>

#include <repel/bullet/arm.hpp>
#include <repel/cell/arm_port.hpp>
#include <repel/cell/cell.hpp>
#include <repel/network/modules/guide.hpp>
#include <repel/runs/setup/describe.hpp>

namespace repel::guides {

namespace {

constexpr double rate_hz = 400.0;
constexpr double period = 1.0 / rate_hz;
constexpr double settling = 5.0;  // [s] before the hand begins; fixtures are on from its end

const Vec3 hole_W(0.6, -0.15, 0.45);  // [m] middle of its mouth
constexpr double hole_depth = 0.06;   // [m] from the mouth to where the peg is in

const std::vector<Vec3>& seam() {
  static const std::vector<Vec3> points{{0.500, -0.260, 0.44}, {0.550, -0.215, 0.44},
                                        {0.615, -0.185, 0.44}, {0.655, -0.120, 0.44},
                                        {0.640, -0.040, 0.44}, {0.580, 0.010, 0.44}};
  return points;
}

std::string text_of(const Vec3& p) {
  return to_text(p.x()) + " " + to_text(p.y()) + " " + to_text(p.z()) + " m";
}

// Eight walls around the hole, 28 mm from its axis: 3 mm between their range
// and the peg.
std::string walls() {
  std::string text;
  for (int i = 0; i < 8; ++i) {
    const double angle = M_PI / 4.0 * i;
    const Vec3 p = hole_W + Vec3(0.038 * std::cos(angle), 0.038 * std::sin(angle), -0.04);
    text += (i > 0 ? ", " : "") + std::string("{name: wall ") + std::to_string(i + 1) +
            ", shape: box, size: 0.020 0.040 0.080 m, position: " + text_of(p) + ", rpy: 0 0 " +
            to_text(45.0 * i) + " deg, law: wall}";
  }
  return text;
}

std::string scene_of(Task task, const std::string& fixtures) {
  const std::string tool = task == Task::seam ? "{name: nozzle, shape: capsule, radius: 6 mm, "
                                                "length: 60 mm, position: 0 0 -36 mm}"
                                              : "{name: peg, shape: cylinder, radius: 15 mm, "
                                                "length: 110 mm, position: 0 0 -55 mm}";
  const std::string guide =
      fixtures.empty() ? "" : "{module: guide, ramp: 0.5 s, fixtures: [" + fixtures + "]}, ";
  return "rate: 400 Hz\nrobot: {urdf: " REPEL_ROBOTS
         "/puma560.urdf, start: 0 45 -180 0 -45 0 deg, tool_frame: {position: "
         "0 0 100 mm}}\n"
         "laws: {wall: {range: 10 mm, surface_force: 200 N, damping: 120 N "
         "s/m}}\ntool: [" +
         tool + "]\nobstacles: [" + (task == Task::seam ? "" : walls()) +
         "]\nnetwork: [{module: six_axes, hand_stiffness: 1 N/mm, "
         "hand_damping: 80 N s/m}, {module: kbb2}, {module: obstacle}, " +
         guide + "{module: puma_kin}, {module: limits}, {module: puma_joints}]\n";
}

/// What the operator sees of the task.
class View {
 public:
  View(Task task, std::uint64_t seed)
      : task_(task), path_(seam(), {}, network::Course::spline), place_{0, 0.0} {
    std::mt19937_64 random(seed + 1000);
    std::uniform_real_distribution<double> aside(-1.0, 1.0);
    const double far = task == Task::seam ? 0.003 : 0.008;
    begin_W_ = task == Task::seam ? seam().front() : Vec3(hole_W + Vec3(0, 0, 0.04));
    begin_W_ += far * Vec3(aside(random), aside(random), 0.0);
  }

  /// To where the task begins.
  [[nodiscard]] Sight approach(const Pose& X_WT) const {
    return {begin_W_ - origin(X_WT), tilt(X_WT), {0, 0, 0}};
  }
  [[nodiscard]] Sight look(const Pose& X_WT) {
    const Vec3 x = origin(X_WT);
    if (task_ == Task::peg) {
      Vec3 error = hole_W - x;
      error.z() = 0.0;
      is_done_ = x.z() < hole_W.z() - hole_depth;
      return {error, tilt(X_WT), {0, 0, -1}};
    }
    place_ = path_.followed(place_, x, 1.0);
    const network::PathPoint point = path_.at(place_);
    const bool is_last = place_.piece + 1 == path_.pieces();
    is_done_ = is_last && place_.along > path_.length(place_.piece) - 3e-3;
    return {point.p_W - x, tilt(X_WT), normalized(point.first_W)};
  }
  [[nodiscard]] bool is_done() const noexcept { return is_done_; }

 private:
  /// By which the tool should turn to point down.
  [[nodiscard]] static Vec3 tilt(const Pose& X_WT) {
    const Vec3 z = rotation(X_WT).col(2);
    return z.cross(Vec3(0, 0, -1));
  }

  Task task_;
  network::FixturePath path_;
  network::PathPlace place_;
  Vec3 begin_W_{0, 0, 0};
  bool is_done_ = false;
};

std::string complaint_of(const network::Network& network, Status seen) {
  if ((seen & (status::failsafe | status::energy_gain)) != 0U) return to_text(seen);
  for (const network::Node& node : network.nodes()) {
    if (!node.traits.passive || node.ledger.deficit() <= 1e-9) continue;
    return "the ledger of " + node.name + " is at " + to_text(node.ledger.least) + " J";
  }
  return {};
}

/// Cell, arm and port, one tick at a time.
class Rig {
 public:
  explicit Rig(const std::string& text) : parsed_(scene::parse(text, "scene")) {
    runs::DescribedScene described = runs::describe(parsed_, rate_hz);
    described.cell.coprocessor.lock_step = true;
    // Dry friction makes a hand hunt for its place, whatever its unrest and the
    // fixtures.
    ArmModel& model = described.cell.arms.front().model;
    for (ArmLink& link : model.links) link.coulomb_friction = 0.0;
    const ArmModel moved = model;
    cell_ = std::make_unique<Cell>(std::move(described.cell));
    arm_ = std::make_unique<bullet::Arm>(moved);
    arm_->reset(parsed_.robot.start);
    port_ = std::make_unique<ArmPort>(*arm_, moved.links.size());
  }
  template <class Command>
  const TickRecord& tick(const Command& command) {
    const ArmReadings readings = port_->read();
    cell_->sense({&readings, 1}, ++ticks_ * cell_->period());
    const network::Command hands = command(cell_->X_WT(0));
    const TickRecord& record = *cell_->act({&hands, 1}).front();
    port_->apply(record);
    arm_->step(period);
    return record;
  }
  [[nodiscard]] const network::Network& network() const { return cell_->network(0); }

 private:
  scene::Scene parsed_;
  std::unique_ptr<Cell> cell_;
  std::unique_ptr<bullet::Arm> arm_;
  std::unique_ptr<ArmPort> port_;
  std::int64_t ticks_ = 0;
};

}  // namespace

std::string seam_points() {
  std::string text;
  for (const Vec3& point : seam()) text += (text.empty() ? "" : ", ") + text_of(point);
  return "[" + text + "]";
}

Outcome run(Task task, const std::string& fixtures, const HandOptions& options,
            std::uint64_t seed) {
  Rig rig(scene_of(task, fixtures));
  View view(task, seed);
  HandOptions calm = options;
  calm.wander = calm.tremor = calm.turning = 0.0;
  Hand approach(calm, seed), hand(options, seed);
  Outcome outcome;
  Status seen = 0;
  double squares = 0.0;
  std::int64_t count = 0;
  const auto ticks = static_cast<std::int64_t>((settling + patience) * rate_hz);
  for (std::int64_t k = 0; k < ticks && !outcome.is_done; ++k) {
    const bool begins = static_cast<double>(k) * period >= settling;
    double error = 0.0;
    const TickRecord& record = rig.tick([&](const Pose& X_WT) {
      network::Command command;
      command.hand.guides = begins ? -1 : 0;
      if (!begins) {
        command.hand.ball = approach.step(view.approach(X_WT), period);
        return command;
      }
      const Sight sight = view.look(X_WT);
      error = norm(sight.error_W);
      command.hand.ball = hand.step(sight, period);
      return command;
    });
    seen |= record.status;
    outcome.wall_force = std::max(outcome.wall_force, norm(record.virtual_force.force));
    if (!begins) continue;
    squares += error * error;
    ++count;
    outcome.worst = std::max(outcome.worst, error);
    outcome.is_done = view.is_done();
  }
  outcome.time = static_cast<double>(count) * period;
  outcome.error = std::sqrt(squares / static_cast<double>(std::max<std::int64_t>(count, 1)));
  if (const auto* guide = rig.network().find<network::Guide>()) {
    for (const auto& held : guide->fixtures()) {
      outcome.guide_force = std::max(outcome.guide_force, held.most_force);
    }
  }
  outcome.complaint = complaint_of(rig.network(), seen);
  return outcome;
}

}  // namespace repel::guides
