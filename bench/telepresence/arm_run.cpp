// SPDX-License-Identifier: BSD-3-Clause
#include "arm_run.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>

#include <repel/bullet/arm.hpp>
#include <repel/cell/arm_port.hpp>
#include <repel/cell/cell.hpp>
#include <repel/runs/setup/describe.hpp>

#include "spectrum.hpp"

namespace repel::telepresence {

namespace {

// The walls are those of the default scene.
std::string text_of(const ArmScene& scene) {
  return "rate: " + to_text(scene.rate_hz) +
         " Hz\nrobot: {urdf: " REPEL_ROBOTS "/puma560.urdf, start: " + scene.start +
         ", tool_frame: {position: 0 0 100 mm}}\n"
         "laws: {wall: {range: 20 mm, surface_force: 200 N, damping: 100 N s/m}}\n"
         "tool: [" +
         scene.tool + "]\nobstacles: [" + scene.obstacles + "]\nnetwork: [" + scene.network +
         ", {module: obstacle}, {module: puma_kin}, "
         "{module: limits}, {module: puma_joints}]\nscript: [" +
         scene.script + "]\n";
}

std::string complaint_of(const network::Network& network, bool finite) {
  if (!finite) return "a force is not finite";
  for (const network::Node& node : network.nodes()) {
    if (!node.traits.passive || node.ledger.deficit() <= 1e-9) continue;
    return "the ledger of " + node.name + " is at " + to_text(node.ledger.least) + " J of " +
           to_text(node.ledger.passed) + " J";
  }
  return {};
}

// Reads angles in steps, and rates as their differences.
class Encoders {
 public:
  Encoders(double step, double rate_hz, std::size_t joints)
      : step_(step), rate_hz_(rate_hz), q_(joints), v_(joints) {}

  [[nodiscard]] ArmReadings read(const ArmReadings& exact) {
    if (!(step_ > 0.0)) return exact;
    for (std::size_t i = 0; i < q_.size(); ++i) {
      const double q = step_ * std::round(exact.q[i] / step_);
      v_[i] = has_read_ ? (q - q_[i]) * rate_hz_ : 0.0;
      q_[i] = q;
    }
    has_read_ = true;
    return {q_, v_, exact.state};
  }

 private:
  double step_;     // [rad]
  double rate_hz_;  // of the readings
  std::vector<double> q_, v_;
  bool has_read_ = false;
};

// What the cell is told of an arm whose friction it does not know, and of its encoders: the watch
// on the joints would take either for a fault.
void tell(const ArmScene& scene, ArmDescription& arm) {
  JointWatchOptions& watch = arm.options.joints;
  if (!scene.compensates_friction) {
    for (ArmLink& link : arm.model.links) link.coulomb_friction = 0.0;
    watch.touches = true;
  }
  if (scene.encoder > 0.0) {
    watch.resolution = scene.encoder;
    watch.repeats = static_cast<int>(std::lround(scene.rate_hz));  // a second
  }
}

}  // namespace

ArmEnd run_arm(const ArmScene& scene, double seconds,
               const std::function<void(const ArmTick&)>& each) {
  const scene::Scene parsed = scene::parse(text_of(scene), "scene");
  runs::DescribedScene described = runs::describe(parsed, scene.rate_hz);
  described.cell.coprocessor.lock_step = true;
  const ArmModel model = described.cell.arms.front().model;
  tell(scene, described.cell.arms.front());
  Cell cell(std::move(described.cell));
  bullet::Arm arm(model);
  arm.reset(parsed.robot.start);
  ArmPort port(arm, model.links.size());
  Encoders encoders(scene.encoder, scene.rate_hz, model.links.size());
  network::ScriptedOperator hands(parsed.script);
  RunTotals totals;
  bool finite = true;
  const auto ticks = std::llround(seconds * scene.rate_hz);
  for (std::int64_t k = 1; k <= ticks; ++k) {
    const ArmReadings readings = encoders.read(port.read());
    cell.sense({&readings, 1}, k * cell.period());
    const network::Command& command = hands.step(cell.X_WT(0).linear(), cell.elapsed());
    const TickRecord& record = *cell.act({&command, 1}).front();
    port.apply(record);
    each({record, cell.X_WT(0), readings.q, cell.network(0)});
    arm.step(1.0 / scene.rate_hz);
    totals.add(record);
    finite = finite && std::isfinite(record.coupling.force.norm() + record.lever_torque);
  }
  ArmEnd end{.complaint = complaint_of(cell.network(0), finite),
             .status_ticks = totals.status_ticks};
  for (const ArmLink& link : model.links) {
    end.ranges.push_back({link.lower, link.upper});
    end.dry_friction.push_back(link.coulomb_friction);
  }
  return end;
}

std::span<const double> Trace::last_second() const {
  const auto second = static_cast<std::size_t>(std::lround(rate_hz));
  return std::span(samples).last(std::min(second, samples.size()));
}

double Trace::mean() const {
  const std::span<const double> last = last_second();
  return std::accumulate(last.begin(), last.end(), 0.0) / static_cast<double>(last.size());
}

// Slope of the least-squares line.
double Trace::drift() const {
  const std::span<const double> last = last_second();
  const auto n = static_cast<double>(last.size());
  double product = 0.0;
  double i = -0.5 * (n - 1.0);
  for (const double sample : last) product += i++ * sample;
  return product / (n * (n * n - 1.0) / 12.0) * rate_hz;
}

double Trace::swing() const {
  const double slope = drift() / rate_hz;
  double low = INFINITY;
  double high = -INFINITY;
  double i = 0.0;
  for (const double sample : last_second()) {
    const double level = sample - slope * i++;
    low = std::min(low, level);
    high = std::max(high, level);
  }
  return high - low;
}

double Trace::chatter() const {
  return rms_above(last_second(), rate_hz, 30.0);
}

double Trace::jump() const {
  return largest_jump(last_second());
}

}  // namespace repel::telepresence
