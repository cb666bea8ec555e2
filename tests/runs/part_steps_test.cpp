// SPDX-License-Identifier: BSD-3-Clause

#include <gtest/gtest.h>

#include <repel/runs/engine/run.hpp>
#include <repel/runs/operator/part_steps.hpp>

namespace repel::runs {
namespace part_steps_test {

/// A scene with an arm at rest, whose tool is a ball, and two parts: one 5 mm away from it, one 1
/// m.
scene::Scene scene_with(const std::string& script) {
  return scene::parse(
      "robot: {urdf: robots/puma560.urdf, start: 0 45 -180 0 -45 0 deg,\n"
      "  tool_frame: {position: 0 0 150 mm}}\n"
      "tool: [{name: ball, shape: sphere, radius: 20 mm}]\n"
      "laws: {default: {range: 20 mm, surface_force: 50 N}}\n"
      "obstacles: []\n"
      "loose:\n"
      "  - {name: near, shape: sphere, radius: 10 mm, position: 0.6313 -0.15 0.4543 m}\n"
      "  - {name: far, shape: sphere, radius: 10 mm, position: 1.6 -0.15 0.4543 m}\n"
      "  - {name: late, shape: sphere, radius: 10 mm, position: 0.6 0.3 0.4 m, at_start: no}\n"
      "script:\n" +
          script,
      REPEL_SOURCE "/scene.yaml");
}

RunResult result_of(const std::string& script, double seconds = 2.0) {
  const scene::Scene scene = scene_with(script);
  RunOptions options;
  options.fast = true;
  options.seconds = seconds;
  options.backend = "ideal";
  const std::atomic<bool> stop{false};
  const auto prepared = prepare(scene, options);
  return run(*prepared, {}, stop, [](const Progress&) {});
}

std::string phase(const std::string& name, const std::string& steps) {
  return "  - {name: " + name + ", device: spaceball, duration: 0.5 s, " + steps + "}\n";
}

TEST(PartSteps, AreMadeWhenTheirPhaseBegins) {
  const RunResult result = result_of(phase("take", "grip: near") + phase("put", "release: near") +
                                     phase("come", "spawn: late") + phase("go", "remove: late"));
  ASSERT_EQ(result.steps.size(), 4U);
  for (const PartStepResult& each : result.steps) {
    EXPECT_TRUE(each.was_made) << "step of phase " << each.step.phase;
    EXPECT_FALSE(each.was_refused);
  }
  EXPECT_NEAR(result.steps[0].distance, 5e-3, 1e-3);
  EXPECT_TRUE(result.warnings.empty()) << result.warnings.front();
  EXPECT_EQ(result.allocations_in_tick, result.allocations_in_tick < 0 ? -1 : 0);
}

TEST(PartSteps, AreLeftOutIfTheyAreNotPossibleAndTheReportSaysSo) {
  const RunResult result = result_of(phase("reach", "grip: far") + phase("put", "release: near") +
                                     phase("come", "spawn: near") + phase("go", "remove: late"));
  ASSERT_EQ(result.warnings.size(), 4U);
  EXPECT_NE(result.warnings[0].find("reach: grip of 'far' was not possible, the tool was 97"),
            std::string::npos)
      << result.warnings[0];
  for (const PartStepResult& each : result.steps) EXPECT_TRUE(each.was_refused);
}

TEST(PartSteps, OfPhasesThatNeverBeginAreNeitherMadeNorRefused) {
  const RunResult result =
      result_of(phase("wait", "over: 0.1 s") + phase("take", "grip: near"), 0.25);
  ASSERT_EQ(result.steps.size(), 1U);
  EXPECT_FALSE(result.steps[0].was_made);
  EXPECT_FALSE(result.steps[0].was_refused);
  EXPECT_TRUE(result.warnings.empty());
}

}  // namespace part_steps_test
}  // namespace repel::runs
