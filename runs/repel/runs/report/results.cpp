// SPDX-License-Identifier: BSD-3-Clause
#include <repel/runs/report/results.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>

#include <repel/host/figure.hpp>
#include <repel/network/modules/force_sensor.hpp>
#include <repel/network/modules/guide.hpp>
#include <repel/network/modules/limits.hpp>
#include <repel/network/modules/puma_joints.hpp>
#include <repel/network/modules/relief.hpp>
#include <repel/runs/records/heading.hpp>

namespace repel::runs {

double support_pairs_per_period(const RunResult& result) {
  const double seconds = std::chrono::duration<double>(result.compute).count();
  if (!(seconds > 0.0)) return 0.0;
  return static_cast<double>(result.totals().iterations) / (seconds * result.options.rate_hz);
}

// Pairs are ordered by obstacle, and within it by part of the tools and arms; but those of a part
// that can come and go with obstacles follow those of arms with it. All that a camera sees is one
// obstacle.
std::vector<std::size_t> obstacles_of_pairs(const World& world) {
  std::vector<std::size_t> places;
  std::vector<PartId> obstacles;
  for (const Pair& pair : world.pairs()) {
    auto at = obstacles.end();
    if (world.part(pair.a).room > 0.0) at = std::find(obstacles.begin(), at, pair.b);
    if (at == obstacles.end() && !obstacles.empty()) {
      const Part& last = world.part(obstacles.back());
      const Part& part = world.part(pair.b);
      const bool is_seen = last.room > 0.0 && part.room > 0.0 && last.name == part.name;
      if (obstacles.back() == pair.b || is_seen) --at;
    }
    places.push_back(static_cast<std::size_t>(at - obstacles.begin()));
    if (at == obstacles.end()) obstacles.push_back(pair.b);
  }
  return places;
}

void note_steps(const PartSteps& steps, RunResult& result) {
  result.steps = steps.results();
  for (const PartStepResult& each : result.steps) {
    if (!each.was_refused) continue;
    const scene::ArmSetup& setup = result.scene.arm_setup(each.arm);
    std::string text = setup.script[each.step.phase].name;
    text.append(": ").append(word_for(each.step.what)).append(" of '");
    text.append(result.scene.loose[each.step.part].name).append("' was not possible");
    if (each.step.what == scene::PartStep::What::grip && std::isfinite(each.distance)) {
      text.append(", the tool was ")
          .append(host::figure(1e3 * each.distance, 1))
          .append(" mm away");
    }
    result.warnings.push_back(text);
  }
}

void note_pairs(const World& world, const Coprocessor& coprocessor, RunResult& result,
                std::span<const double> withstood) {
  RunTotals& totals = result.arms.front().totals;
  const std::vector<std::size_t> places = obstacles_of_pairs(world);
  for (std::int32_t i = 0; i < static_cast<std::int32_t>(world.pairs().size()); ++i) {
    const Pair& pair = world.pair({i});
    const std::size_t place = places[static_cast<std::size_t>(i)];
    if (place == result.obstacles.size()) {
      result.obstacles.push_back({.name = world.part(pair.b).name});
    }
    if (result.options.keep_records) result.pair_names.push_back(name_of(world, {i}));
    const PairExtremes extremes = coprocessor.extremes_of({i});
    totals.deepest = std::max(totals.deepest, extremes.deepest);
    (pair.law.passable ? result.passables : result.walls).add(extremes);
    // Includes evaluations before the first tick; not finite if nothing was near.
    if (std::isfinite(extremes.nearest) && extremes.nearest <= totals.nearest) {
      totals.nearest = extremes.nearest;
      result.nearest_pair = name_of(world, {i});
    }
    ObstacleResult& obstacle = result.obstacles[place];
    obstacle.is_hard = obstacle.is_hard || pair.law.hold == HoldKind::hard;
    if (!withstood.empty()) {
      obstacle.withstood = std::max(obstacle.withstood, withstood[static_cast<std::size_t>(i)]);
    }
    const bool hardest = extremes.peak_force > obstacle.extremes.peak_force;
    obstacle.extremes.add(extremes);
    if (!hardest) continue;
    obstacle.part = world.part(pair.a).name;
    obstacle.body = world.body_name(world.part(pair.a).body);
  }
}

std::vector<ModuleResult> module_results(const network::Network& network) {
  std::vector<ModuleResult> results;
  for (const network::Node& node : network.nodes()) {
    // Not one of those that the scene lists, and the last.
    if (node.module.as<network::Prediction>() != nullptr) continue;
    ModuleResult result;
    result.name = node.name;
    result.claims_passive = node.traits.passive && !node.traits.measures_flow;
    result.ledger = node.ledger;
    result.passivity = node.module->passivity().value_or(network::PassivityReport{});
    if (const auto* joints = node.module.as<network::PumaJoints>()) {
      result.sampling_energy = joints->sampling_energy();
    }
    if (const auto* kbb2 = node.module.as<network::Kbb2>()) result.coupling = kbb2->options();
    if (const auto* relief = node.module.as<network::Relief>()) result.given = relief->most_given();
    if (const auto* limits = node.module.as<network::Limits>()) {
      for (int i = 0; i < limits->size(); ++i) {
        result.limit_torques.push_back(limits->most_torque(i));
      }
    }
    if (const auto* guide = node.module.as<network::Guide>()) {
      for (const network::Guide::Held& held : guide->fixtures()) {
        result.fixtures.push_back(
            {held.options.name, held.along.stiffness(), held.damping, held.most_force});
      }
    }
    if (const auto* sensor = node.module.as<network::ForceSensor>()) {
      result.sensor = {sensor->peak_force(), sensor->saturated_ticks(), sensor->lost_ticks()};
    }
    results.push_back(result);
  }
  return results;
}

bool gained_energy(const RunResult& result) {
  constexpr auto bit = static_cast<std::size_t>(std::countr_zero(status::energy_gain));
  return std::any_of(result.arms.begin(), result.arms.end(),
                     [&](const ArmResult& arm) { return arm.totals.status_ticks[bit] > 0; });
}

bool was_often_at_fault(const RunResult& result) {
  // A watchdog stops the drive after 0.1 s without ticks, and it is enabled within 0.5 s: five
  // ticks for each missed one, and as many again for the motion back to the operator.
  return std::any_of(result.arms.begin(), result.arms.end(), [&](const ArmResult& arm) {
    // A replay skips none; those of its recording are missing.
    const std::int64_t excused = 10 * std::max(result.skipped_ticks, arm.totals.missing);
    return 10 * (arm.totals.unsound - excused) > arm.totals.ticks;
  });
}

int exit_status(const RunResult& result) {
  if (result.replay.same != result.replay.ticks) return 3;
  if (!result.log_trouble.empty()) return 4;
  return gained_energy(result) || was_often_at_fault(result) ? 5 : 0;
}

}  // namespace repel::runs
