// SPDX-License-Identifier: BSD-3-Clause
// Virtual fixtures of a scene file, and the phases that switch them and the compliance.
#include <gtest/gtest.h>

#include <repel/base/setup_error.hpp>
#include <repel/network/modules.hpp>
#include <repel/scene/build_network.hpp>

#include "yaml_text.hpp"

namespace repel::scene {
namespace guide_test {

using network::Alignment;
using network::FixtureKind;
using testing::base_scene;
using testing::options;
using testing::parsed;

Scene with(const std::string& fixtures, const std::string& script = "") {
  return parsed(base_scene + "network:\n  - {module: relief, frame: world}\n" +
                "  - module: guide\n    ramp: 100 ms\n    entry_energy: 0.5 J\n    fixtures:\n" +
                fixtures + script);
}
network::GuideOptions guide_of(const Scene& scene) {
  for (const Module& module : scene.network.modules) {
    if (module.kind == "guide") return *std::any_cast<network::GuideOptions>(&module.options);
  }
  throw std::runtime_error("no guide");
}
std::string refusal(const std::string& fixtures, const std::string& script = "") {
  try {
    (void)with(fixtures, script);
  } catch (const SetupError& error) {
    return std::string(error.what()) + " in line " + std::to_string(error.line());
  }
  return {};
}

TEST(SceneGuide, EveryNumberOfAFixtureArrives) {
  const network::GuideOptions guide = guide_of(
      with("      - {name: hole, shape: axis, position: 1 2 3 m, rpy: 90 0 0 deg, radius: 1 mm,\n"
           "         stiffness: 2 N/mm, damping: 90 N s/m, most_force: 20 N, range: 60 mm,\n"
           "         most_energy: 0.4 J, angular_stiffness: auto, angular_damping: 0.3 N m s/rad,\n"
           "         most_torque: 2 N m, angular_range: 30 deg, on: no}\n"
           "      - {name: funnel, shape: cone, half_angle: 0.5 rad}\n"
           "      - {name: seam, shape: path, points: [0 0 0 m, 0.1 0 0 m, 0.2 0.1 0 m], course:\n"
           "         straight, frames: [0 0 0 deg, 0 90 0 deg, 0 90 0 deg]}\n"
           "      - {name: pipe, shape: tube, radius: 5 mm, points: [0 0 0 m, 0.1 0 0 m]}\n"
           "      - {name: bore, shape: tube, radius: 5 mm}\n"
           "      - {name: sheet, shape: plane}\n"
           "      - {name: spot, shape: point, stiffness: auto, alignment: all}\n"));
  EXPECT_EQ(guide.ramp, 0.1);
  EXPECT_EQ(guide.entry_energy, 0.5);
  ASSERT_EQ(guide.fixtures.size(), 7U);
  const network::FixtureOptions& hole = guide.fixtures[0];
  EXPECT_EQ(hole.kind, FixtureKind::line);
  EXPECT_EQ(hole.alignment, Alignment::axis);
  EXPECT_EQ(Vec3(hole.X_WF.translation()), Vec3(1, 2, 3));
  EXPECT_NEAR(hole.X_WF.linear()(1, 2), -1.0, 1e-12);
  EXPECT_EQ(hole.radius, 0.001);
  EXPECT_EQ(hole.stiffness, 2000.0);
  EXPECT_EQ(hole.damping, 90.0);
  EXPECT_EQ(hole.most_force, 20.0);
  EXPECT_EQ(hole.range, 0.06);
  EXPECT_EQ(hole.most_energy, 0.4);
  EXPECT_EQ(hole.angular_stiffness, network::automatic);
  EXPECT_EQ(hole.angular_damping, 0.3);
  EXPECT_EQ(hole.most_torque, 2.0);
  EXPECT_NEAR(hole.angular_range, M_PI / 6.0, 1e-12);
  EXPECT_FALSE(hole.is_on);
  EXPECT_EQ(guide.fixtures[1].kind, FixtureKind::cone);
  EXPECT_EQ(guide.fixtures[2].points.size(), 3U);
  EXPECT_EQ(guide.fixtures[2].course, network::Course::straight);
  EXPECT_EQ(guide.fixtures[2].alignment, Alignment::all);
  EXPECT_NEAR(guide.fixtures[2].frames[1](0, 2), 1.0, 1e-12);
  EXPECT_EQ(guide.fixtures[3].kind, FixtureKind::path);
  EXPECT_EQ(guide.fixtures[3].course, network::Course::spline);
  EXPECT_EQ(guide.fixtures[4].kind, FixtureKind::line);
  EXPECT_EQ(guide.fixtures[4].alignment, Alignment::free);
  EXPECT_EQ(guide.fixtures[5].kind, FixtureKind::plane);
  EXPECT_EQ(guide.fixtures[6].stiffness, network::automatic);
  EXPECT_EQ(guide.fixtures[6].damping, network::automatic) << "by default";
  EXPECT_TRUE(guide.fixtures[6].is_on);
}

TEST(SceneGuide, PhasesSwitchFixturesAndCompliance) {
  const std::string head = "  - {name: ";
  const std::string ball = ", device: spaceball, duration: 1 s";
  const Scene scene = with("      - {name: a, shape: point}\n      - {name: b, shape: line}\n",
                           "script:\n" + head + "one" + ball + "}\n" + head + "two" + ball +
                               ", guides: [b], guide_strength: 50 %}\n" + head + "three" + ball +
                               ", guides: [], compliant: [x, rz], compliant_frame: tool}\n" + head +
                               "four" + ball + ", guides: [a, b], compliant: [z]}\n");
  ASSERT_EQ(scene.script.size(), 4U);
  EXPECT_EQ(scene.script[0].guides, network::as_before);
  EXPECT_EQ(scene.script[0].compliant, network::as_before);
  EXPECT_LT(scene.script[0].guide_strength, 0.0);
  EXPECT_EQ(scene.script[1].guides, 2);
  EXPECT_EQ(scene.script[1].guide_strength, 0.5);
  EXPECT_EQ(scene.script[2].guides, 0);
  EXPECT_EQ(scene.script[2].compliant, 1 + 32);
  EXPECT_EQ(scene.script[3].guides, 3);
  EXPECT_EQ(scene.script[3].compliant, 4 + network::Relief::world_bit) << "as the module has it";
}

TEST(SceneGuide, RefusesWhatIsNoFixtureWithItsLine) {
  const auto expect = [](const std::string& said, const std::string& part) {
    EXPECT_NE(said.find(part), std::string::npos) << said;
  };
  expect(refusal("      - {name: a, shape: circle}\n"), "circle");
  expect(refusal("      - {name: a, shape: point, half_angle: 0.5 rad}\n"), "half_angle");
  expect(refusal("      - {name: a, shape: path}\n"), "points");
  expect(refusal("      - {name: a, shape: path, points: [0 0 0 m]}\n"), "number of points");
  expect(refusal("      - {name: a, shape: tube}\n"), "radius");
  expect(refusal("      - {name: a, shape: path, points: [0 0 0 m, 1 0 0 m], alignment: axis}\n"),
         "no frames");
  expect(refusal("      - {name: a, shape: point}\n      - {name: a, shape: line}\n"), "other");
  const std::string phase = "script:\n  - {name: one, device: spaceball, duration: 1 s, ";
  expect(refusal("      - {name: a, shape: point}\n", phase + "guides: [b]}\n"), "fixture");
  expect(refusal("      - {name: a, shape: point}\n", phase + "compliant_frame: tool}\n"), "both");
}

TEST(SceneGuide, RefusesPhasesWithoutTheModuleAndASecondGuide) {
  const auto refused = [](const std::string& text) {
    try {
      (void)parsed(base_scene + text);
    } catch (const SetupError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const std::string phase = "script:\n  - {name: one, device: spaceball, duration: 1 s, ";
  EXPECT_NE(refused(phase + "guides: [b]}\n").find("without a module 'guide'"), std::string::npos);
  EXPECT_NE(refused("network: [{module: kbb2}]\n" + phase + "compliant: [x]}\n")
                .find("without a module 'relief'"),
            std::string::npos);
  const std::string guide = "  - {module: guide, fixtures: [{name: a, shape: point}]}\n";
  EXPECT_NE(refused("network:\n" + guide + guide).find("second module"), std::string::npos);
}

}  // namespace guide_test
}  // namespace repel::scene
