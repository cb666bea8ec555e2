// SPDX-License-Identifier: BSD-3-Clause
// What a report says of walls and of passable bodies, and the modules that claim to be passive.

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <sstream>

#include <repel/runs/report/network_report.hpp>
#include <repel/runs/report/report.hpp>
#include <repel/runs/report/results.hpp>

namespace repel::runs {
namespace results_test {

/// A tool that may be inside a wall, a membrane, both or neither.
struct Stage {
  Stage() {
    tool = world.add_body("tool");
    block = world.add_part(tool, "block", Shape::box({0.1, 0.1, 0.1}));
  }
  /// @param into_wall, into_membrane [m] negative: apart
  Stage(double into_wall, double into_membrane) : Stage() {
    add("membrane", -0.2 + into_membrane,
        {.range = 0.02, .surface_force = 50.0, .ceiling = 10.0, .passable = true});
    add("wall", 0.2 - into_wall, {.range = 0.02});
  }

  void add(const char* name, double x, const ForceLaw& law) {
    Pose X = Pose::Identity();
    X.translation().x() = x;
    const PartId other = world.add_part(World::fixed, name, Shape::box({0.1, 0.5, 0.5}), X);
    world.add_pair(block, other, law);
  }

  nlohmann::json report() {
    EXPECT_TRUE(world.place(tool, Pose::Identity(), {}));
    Coprocessor coprocessor(world, {});
    (void)coprocessor.exchange();
    RunResult result;
    result.arms.resize(1);
    note_pairs(world, coprocessor, result);
    std::ostringstream text;
    write_json(result, text);
    return nlohmann::json::parse(text.str());
  }

  World world;
  BodyId tool;
  PartId block;
};

TEST(Results, TellIntrusionsIntoWallsFromThoseIntoPassableBodies) {
  const nlohmann::json passed = Stage(-0.005, 0.03).report();
  EXPECT_NEAR(passed.at("nearest_wall_m"), 0.005, 1e-9);
  EXPECT_EQ(passed.at("deepest_wall_m"), 0.0);
  EXPECT_NEAR(passed.at("nearest_passable_m"), -0.03, 1e-6);
  EXPECT_NEAR(passed.at("deepest_passable_m"), 0.03, 1e-6);
  EXPECT_EQ(passed.at("nearest_pair"), "block - membrane");

  const nlohmann::json hit = Stage(0.01, -0.004).report();
  EXPECT_NEAR(hit.at("nearest_wall_m"), -0.01, 1e-6);
  EXPECT_NEAR(hit.at("deepest_wall_m"), 0.01, 1e-6);
  EXPECT_NEAR(hit.at("nearest_passable_m"), 0.004, 1e-9);
  EXPECT_EQ(hit.at("deepest_passable_m"), 0.0);
  EXPECT_EQ(hit.at("nearest_pair"), "block - wall");
}

TEST(Results, CountWallsAndPassableBodiesTogetherInTheKeysOfAllPairs) {
  for (const auto& [wall, membrane] : {std::pair(0.01, 0.03), std::pair(0.03, 0.01)}) {
    const nlohmann::json both = Stage(wall, membrane).report();
    const auto number = [&both](const char* key) { return both.at(key).get<double>(); };
    EXPECT_EQ(number("deepest_m"),
              std::max(number("deepest_wall_m"), number("deepest_passable_m")));
    EXPECT_EQ(number("nearest_m"),
              std::min(number("nearest_wall_m"), number("nearest_passable_m")));
    EXPECT_NEAR(both.at("deepest_m"), 0.03, 1e-6);
    for (const nlohmann::json& obstacle : both.at("obstacles")) {
      const bool is_wall = obstacle.at("name") == "wall";
      EXPECT_EQ(obstacle.at("deepest_m"),
                both.at(is_wall ? "deepest_wall_m" : "deepest_passable_m"));
    }
  }
}

TEST(Results, SayThatThereIsNothingOfAKind) {
  Stage walled;
  walled.add("wall", 0.19, {.range = 0.02});
  const nlohmann::json report = walled.report();
  EXPECT_NEAR(report.at("deepest_wall_m"), 0.01, 1e-6);
  EXPECT_TRUE(report.at("nearest_passable_m").is_null());
  EXPECT_EQ(report.at("deepest_passable_m"), 0.0);
  EXPECT_TRUE(Stage().report().at("nearest_wall_m").is_null());
}

/// What reports say of a module after these energies [J] into it.
nlohmann::json report_of(bool claims_passive, std::initializer_list<double> energies) {
  ModuleResult module;
  module.claims_passive = claims_passive;
  for (const double energy : energies) module.ledger.add(energy, std::abs(energy), 0.0);
  return modules_to_json({module}).at(0);
}

// Regression: a module was called passive because it claims to be, with 0.1 J missing in its
// ledger.
TEST(Results, CallPassiveOnlyWhatReturnedNoMoreThanItTook) {
  const nlohmann::json kept = report_of(true, {1.0, -1.0 - 1e-12});
  EXPECT_TRUE(kept.at("passive")) << "rounding";
  const nlohmann::json broken = report_of(true, {1.0, -1.1, 3.0});
  EXPECT_FALSE(broken.at("passive")) << "whatever it took later";
  EXPECT_TRUE(broken.at("claims_passive"));
  EXPECT_NEAR(broken.at("least_j"), -0.1, 1e-12);
  const nlohmann::json robot = report_of(false, {1.0});
  EXPECT_FALSE(robot.at("passive")) << "it may return more at any time";
  EXPECT_FALSE(robot.at("claims_passive"));
}

TEST(Results, RunIsOftenAtFaultInMoreThanATenthOfTheTicksOfSomeArm) {
  RunResult result;
  result.arms.resize(2);
  EXPECT_FALSE(was_often_at_fault(result)) << "it had no tick";
  for (ArmResult& arm : result.arms) arm.totals.ticks = 1000;
  result.arms[1].totals.unsound = 100;
  EXPECT_FALSE(was_often_at_fault(result));
  result.arms[1].totals.unsound = 101;
  EXPECT_TRUE(was_often_at_fault(result));
}

// A run of one second on a machine that stopped it for 160 ms ended with 5: its drive was enabled
// again after 0.25 s.
TEST(Results, WhatTheMachineHeldUpIsNoFaultOfTheArm) {
  RunResult result;
  RunTotals& totals = result.arms.emplace_back().totals;
  totals.ticks = 400;
  totals.unsound = 120;
  EXPECT_TRUE(was_often_at_fault(result));
  totals.missing = 64;
  EXPECT_FALSE(was_often_at_fault(result)) << "a replay";
  totals.missing = 0;
  result.skipped_ticks = 64;
  EXPECT_FALSE(was_often_at_fault(result));
  totals.ticks = totals.unsound = 1000;
  EXPECT_TRUE(was_often_at_fault(result));
}

}  // namespace results_test
}  // namespace repel::runs
