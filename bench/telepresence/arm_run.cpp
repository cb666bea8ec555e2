#include "arm_run.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>

#include <repel/bullet/arm.hpp>
#include <repel/loop/tick.hpp>

#include "cell.hpp"
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
         ", {module: obstacle, gain_check: warning}, {module: puma_kin}, "
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

}  // namespace

ArmEnd run_arm(const ArmScene& scene, double seconds,
               const std::function<void(const ArmTick&)>& each) {
  const scene::Scene parsed = scene::parse(text_of(scene), "scene");
  teleop::Cell cell(parsed, true);
  const ArmModel& model = cell.arm().robot.arm;
  bullet::Arm arm(model);
  arm.reset(cell.arm().start);
  const std::chrono::nanoseconds period(std::llround(1e9 / scene.rate_hz));
  CoprocessorOptions in_lock_step;
  in_lock_step.period = period;
  in_lock_step.lock_step = true;
  Coprocessor coprocessor(cell.world, in_lock_step);
  network::ScriptedOperator the_operator(parsed.script);
  Kinematics& kinematics = cell.arm().kinematics;
  Teleoperator teleoperator(model, arm, kinematics, cell.world, cell.arm().tool, coprocessor,
                            the_operator,
                            scene::build_network(parsed, parsed, model, scene.rate_hz), period);
  std::vector<double> q(model.links.size());
  RunTotals totals;
  bool finite = true;
  const auto ticks = std::llround(seconds * scene.rate_hz);
  for (std::int64_t k = 1; k <= ticks; ++k) {
    const TickRecord& record = teleoperator.tick(k * period);
    arm.read_positions(q);
    each({record, kinematics.X_WT(), q, teleoperator.network()});
    arm.step(1.0 / scene.rate_hz);
    totals.add(record);
    finite = finite && std::isfinite(record.coupling.force.norm() + record.lever_torque);
  }
  coprocessor.stop();
  ArmEnd end{.complaint = complaint_of(teleoperator.network(), finite),
             .status_ticks = totals.status_ticks};
  for (const ArmLink& link : model.links) end.ranges.push_back({link.lower, link.upper});
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

// The slope of the line with the least squares.
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

}  // namespace repel::telepresence
