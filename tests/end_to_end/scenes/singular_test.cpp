// SPDX-License-Identifier: BSD-3-Clause
// Motion through the singularities of a PUMA while walls act on tool and arm.
#include "end_to_end/teleop.hpp"

namespace repel::test {
namespace singular_test {

using nlohmann::json;

struct Way {
  const char* name;
  const char* start;      ///< [deg]
  const char* obstacles;  ///< with the law of the table
  const char* script;
  const char* joint;  ///< the joint that passes through the singularity
  double singular;    ///< [rad] its singular position
};

/// Runs a path and checks the conditions common to all.
void expect_bounded(const Way& way) {
  SCOPED_TRACE(way.name);
  const Folder folder;
  const std::string scene =
      "robot:\n  urdf: " REPEL_SOURCE "/robots/puma560.urdf\n  start: " + std::string(way.start) +
      " deg\n  tool_frame: {position: 0 0 100 mm}\n"
      "tool: [{name: rod, shape: capsule, radius: 15 mm, length: 60 mm, position: 0 0 -30 mm}]\n"
      "laws:\n  default: {range: 60 mm, surface_force: 120 N, damping: 60 N s/m}\n"
      "obstacles:\n" +
      way.obstacles +
      "network:\n  - {module: torque_arm}\n  - {module: multiplex}\n  - {module: spaceball}\n"
      "  - {module: kbb2, stiffness: 3 N/mm, damping: 300 N s/m, force_limit: 120 N}\n"
      "  - {module: obstacle, gain_check: warning}\n  - {module: puma_kin}\n"
      "  - {module: arm_obstacle}\n  - {module: limits}\n  - {module: puma_joints}\n"
      "script:\n" +
      way.script;
  const Ending ending =
      teleop(quoted(folder.with("singular.yaml", scene)) + " --fast --seconds 8 --log " +
             quoted(folder / "log.csv") + " --report " + quoted(folder / "r.json"));
  ASSERT_EQ(ending.status, 0) << ending;
  const json report = report_of(folder / "r.json");
  // The operator may press with 120 N, which is what the law gives at the surface: the tool comes
  // to rest there and may enter by a fraction of a millimetre (0.3 mm seen).
  EXPECT_LT(report.at("deepest_m"), 0.001);
  EXPECT_GT(report.at("obstacles").at(0).at("peak_force_n"), 5.0) << "a wall must push";
  for (const json& module : report.at("modules")) {
    if (!module.at("claims_passive").get<bool>()) continue;
    EXPECT_LE(module.at("deficit"), 1e-9) << module;
  }
  const Columns log = columns_of(folder / "log.csv");
  expect_finite_forces(log);
  const auto& q = log.at(way.joint);
  const auto [least, most] = std::minmax_element(q.begin(), q.end());
  EXPECT_LT(*least, way.singular) << "it must come through";
  EXPECT_GT(*most, way.singular);
  for (int joint = 1; joint <= 6; ++joint) {
    const auto& angle = log.at("q" + std::to_string(joint) + "_rad");
    for (std::size_t tick = 1; tick < angle.size(); ++tick) {
      const double rate = 400.0 * std::abs(angle[tick] - angle[tick - 1]);
      ASSERT_LE(rate, joint < 4 ? 1.5 : 4.0) << "joint " << joint << ", tick " << tick;
    }
  }
}

TEST(Singular, WristGoesThroughItsOwnWhileATablePushesTheTool) {
  expect_bounded(
      {"wrist", "0 45 -180 0 -20 0",
       "  - {name: table, shape: box, size: 0.6 0.8 0.05 m, position: 0.7 -0.15 0.41 m}\n",
       "  - {name: turn, device: spaceball, duration: 5 s, linear: 0 30 -40 mm/s, angular: 0 -12 0 "
       "deg/s}\n"
       "  - {name: across, device: spaceball, duration: 2 s, linear: 0 -120 0 mm/s}\n",
       "q5_rad", 0.0});
}

// Stretched out: the hand keeps pulling and the upper arm rests on a shelf.
TEST(Singular, ElbowGoesThroughItsOwnWhileAShelfHoldsTheUpperArm) {
  expect_bounded(
      {"elbow", "0 20 -135 0 -60 0",
       "  - {name: shelf, shape: box, size: 0.3 0.8 0.05 m, position: 0.4 -0.15 0.48 m}\n",
       "  - {name: stretch, device: spaceball, duration: 5 s, linear: 120 0 20 mm/s}\n"
       "  - {name: back, device: spaceball, duration: 2 s, linear: -120 60 0 mm/s}\n",
       "q3_rad", -1.618});
}

}  // namespace singular_test
}  // namespace repel::test
