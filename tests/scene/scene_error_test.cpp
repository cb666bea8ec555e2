// SPDX-License-Identifier: BSD-3-Clause
// Every error in a scene file is reported with its line, the value found and the allowed values.
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include <repel/base/setup_error.hpp>
#include <scene/yaml_text.hpp>

namespace repel::scene {
namespace scene_error_test {

using testing::base_scene;
using testing::changed;
using testing::parsed;

/// `text` must be refused at `line`, with a message that contains each of `words`.
void expect_refused(const std::string& text, int line, std::initializer_list<std::string> words) {
  SCOPED_TRACE(text);
  try {
    (void)parsed(text);
    ADD_FAILURE() << "the scene was accepted";
  } catch (const SetupError& error) {
    EXPECT_EQ(error.line(), line) << error.what();
    EXPECT_EQ(error.file(), "scenes/test.yaml");
    for (const std::string& word : words) {
      EXPECT_NE(std::string(error.what()).find(word), std::string::npos)
          << "no \"" << word << "\" in: " << error.what();
    }
  }
}

TEST(SceneError, TheUnchangedSceneIsAccepted) {
  EXPECT_NO_THROW((void)parsed(base_scene));
}

TEST(SceneError, AnUnknownKeyIsRefusedAndTheNearestNamed) {
  expect_refused(base_scene + "obstcles: []\n", 8, {"'obstcles'", "mean 'obstacles'"});
  expect_refused(changed("radius", "raduis"), 5, {"'raduis'", "mean 'radius'"});
  expect_refused(changed("start", "strat"), 3, {"'strat'", "mean 'start'"});
  expect_refused(base_scene + "laws:\n  wall:\n    celing: 3 N\n", 10, {"mean 'ceiling'"});
  const auto module = [](const std::string& text) {
    return base_scene + "network:\n  - {module: " + text + "}\n";
  };
  expect_refused(module("spaceball, deadband: 1 mm/s"), 9, {"mean 'dead_band'"});
  expect_refused(module("kbb2, stifness: 1 N/m"), 9, {"mean 'stiffness'"});
  expect_refused(module("torque_arm, inertai: 1 kg m^2"), 9, {"mean 'inertia'"});
  expect_refused(base_scene + "budget: {wal: 1 ms}\n", 8, {"mean 'wall'"});
}

TEST(SceneError, AnUnknownKeyLikeNoOtherIsRefusedWithAllThatAreAllowed) {
  expect_refused(base_scene + "xyzzy: 1\n", 8, {"'xyzzy'; allowed: name, rate, robot, tool"});
}

TEST(SceneError, AStartInsideOrAToolSpeedThatIsNotAllowedIsRefused) {
  expect_refused(base_scene + "start_inside: push\n", 8, {"'push'", "refuse", "push_out"});
  expect_refused(base_scene + "start_inside: yes\n", 8, {"'yes'", "push_out"});
  expect_refused(base_scene + "tool_speed: 0.0009 m/s\n", 8, {"tool_speed", "0.001", "10 m/s"});
  expect_refused(base_scene + "tool_speed: 10.1 m/s\n", 8, {"tool_speed", "0.001", "10 m/s"});
  expect_refused(base_scene + "tool_speed: 0.25\n", 8, {"tool_speed", "m/s"});
  expect_refused(base_scene + "tool_speed: 5 rad/s\n", 8, {"tool_speed", "m/s"});
}

TEST(SceneError, AMeasureThatIsNoneOrLevelsOutOfRangeAreRefused) {
  expect_refused(base_scene + "measure: tree\n", 8,
                 {"'tree'", "deepest_point", "reduction", "exact"});
  expect_refused(base_scene + "measure: [exact]\n", 8, {"measure"});
  expect_refused(base_scene + "levels: 0\n", 8, {"levels", "'0'", "1 to 64"});
  expect_refused(base_scene + "levels: 65\n", 8, {"levels", "'65'", "1 to 64"});
  expect_refused(base_scene + "levels: 2.5\n", 8, {"levels", "'2.5'"});
  expect_refused(base_scene + "levels: 8 mm\n", 8, {"levels", "'8 mm'"});
  expect_refused(base_scene + "mesure: exact\n", 8, {"mean 'measure'"});
}

TEST(SceneError, ASizeOfAnotherShapeIsRefused) {
  expect_refused(changed("radius: 20 mm", "radius: 20 mm, size: 1 1 1 m"), 5, {"'size'"});
  expect_refused(changed("size: 1 2 3 m", "size: 1 2 3 m, length: 1 m"), 7, {"'length'"});
  expect_refused(changed("radius: 20 mm", "radius: 20 mm, law: wall"), 5, {"'law'"});
}

TEST(SceneError, ARateOfTheOtherDeviceIsRefused) {
  expect_refused(base_scene +
                     "script:\n"
                     "  - {name: a, device: spaceball, duration: 1 s, lever: 1 rad/s}\n",
                 9, {"'lever'"});
  expect_refused(base_scene +
                     "script:\n"
                     "  - {name: a, device: torque_arm, duration: 1 s, linear: 1 0 0 m/s}\n",
                 9, {"'linear'"});
}

TEST(SceneError, ANumberWithoutItsUnitIsRefusedAndTheUnitsNamed) {
  expect_refused(changed("20 mm", "20"), 5, {"'radius' is '20'", "m, cm or mm"});
  expect_refused(changed("0 45 180 0 45 0 deg", "0 45 180 0 45 0"), 3, {"rad or deg"});
  expect_refused(base_scene + "rate: 400\n", 8, {"Hz or kHz"});
}

TEST(SceneError, AUnitOfAnotherDimensionIsRefused) {
  expect_refused(changed("20 mm", "20 N"), 5, {"'20 N'", "m, cm or mm"});
  expect_refused(changed("20 mm", "20 inch"), 5, {"'20 inch'"});
  expect_refused(changed("20 mm", "20mm"), 5, {"'20mm'"});
  expect_refused(changed("20 mm", "20 MM"), 5, {"'20 MM'"});
  expect_refused(base_scene + "laws: {wall: {damping: 80 N/m}}\n", 8, {"N s/m or kN s/m"});
  expect_refused(base_scene + "budget: {work: 20 ms}\n", 8, {"a whole number"});
}

TEST(SceneError, AWrongCountOfNumbersIsRefused) {
  expect_refused(changed("1 2 3 m", "1 2 m"), 7, {"'1 2 m'", "3 numbers"});
  expect_refused(changed("1 2 3 m", "1 2 3 4 m"), 7, {"3 numbers"});
  expect_refused(changed("20 mm", "20 30 mm"), 5, {"1 number"});
  expect_refused(changed("20 mm", "mm"), 5, {"1 number"});
  expect_refused(changed("0 45 180 0 45 0 deg", "deg"), 3, {"1 to 64 numbers"});
  expect_refused(changed("1 2 3 m", "'1, 2, 3 m'"), 7, {"3 numbers"});
  expect_refused(changed("size: 1 2 3 m", "size: [1, 2, 3]"), 7, {"'size' is a list"});
}

TEST(SceneError, ANumberThatIsNoneIsRefused) {
  for (const std::string number : {"2O", "0x10", "1e999", "1,5", "--1", "1_0", "+-3"}) {
    expect_refused(changed("20 mm", "'" + number + " mm'"), 5, {"1 number"});
  }
}

TEST(SceneError, ANegativeSizeIsRefusedWithItsRange) {
  expect_refused(changed("20 mm", "-20 mm"), 5, {"'radius' is '-20 mm'", "0 to 1e+06 m"});
  expect_refused(changed("1 2 3 m", "1 -2 3 m"), 7, {"'1 -2 3 m'", "0 to 1e+06 m"});
}

TEST(SceneError, AnythingNotFiniteIsRefusedWhereItIsNoTest) {
  for (const std::string bad : {"nan", "inf", "-inf", "NaN", "infinity"}) {
    expect_refused(changed("20 mm", bad + " mm"), 5, {"allowed"});
    expect_refused(changed("1 2 3 m", "1 " + bad + " 3 m"), 7, {"allowed"});
    expect_refused(changed("1 2 3 m", "1 2 3 m, position: 0 0 " + bad + " m"), 7, {"allowed"});
    expect_refused(changed("1 2 3 m", "1 2 3 m, rpy: 0 0 " + bad + " deg"), 7, {"allowed"});
    expect_refused(changed("0 45 180", "0 " + bad + " 180"), 3, {"allowed"});
    expect_refused(base_scene + "rate: " + bad + " Hz\n", 8, {"allowed"});
    expect_refused(base_scene + "laws: {a: {ceiling: " + bad + " N}}\n", 8, {"allowed"});
    expect_refused(base_scene + "network: [{module: kbb2, damping: " + bad + " N s/m}]\n", 8,
                   {"allowed"});
  }
}

TEST(SceneError, APassableLawNeedsALowCeilingAndOnlyItHasADepth) {
  const std::string law = base_scene + "laws: {a: {surface_force: 60 N, ";
  expect_refused(law + "passable: maybe}}\n", 8, {"'maybe'", "yes", "no"});
  expect_refused(law + "passable: yes}}\n", 8, {"ceiling of a passable body", "inf N", "30 N"});
  expect_refused(law + "passable: yes, ceiling: 31 N}}\n", 8, {"31 N", "30 N"});
  expect_refused(law + "passable: yes, ceiling: 0 N}}\n", 8, {"0 N", "allowed"});
  expect_refused(law + "ceiling: 5 N, depth: 1 mm}}\n", 8, {"'depth'", "allowed"});
  expect_refused(law + "passable: no, plateau: 0.5}}\n", 8, {"'plateau'", "allowed"});
  const std::string passable = law + "passable: yes, ceiling: 5 N, ";
  expect_refused(passable + "depth: -1 mm}}\n", 8, {"'-1 mm'", "0 to 1e+06 m"});
  expect_refused(passable + "plateau: 1.1}}\n", 8, {"'1.1'", "0 to 1"});
}

TEST(SceneError, AWallIsHardOrSoftAndWhatMayBeEnteredIsSoft) {
  const std::string law = base_scene + "laws: {a: {hold: ";
  expect_refused(law + "firm}}\n", 8, {"'hold' is 'firm'", "allowed: soft", "hard"});
  expect_refused(law + "hard, passable: yes, ceiling: 5 N}}\n", 8,
                 {"hold is hard for a passable body", "allowed: soft"});
}

TEST(SceneError, ALawIsGivenAtThePartOrAtTheTool) {
  const std::string law = base_scene + "laws: {a: {given_at: ";
  expect_refused(law + "hand}}\n", 8, {"'given_at' is 'hand'", "allowed: part", "tool"});
  expect_refused(law + "[tool]}}\n", 8, {"'given_at'"});
}

TEST(SceneError, AnInfiniteRateOfTheOperatorIsRefused) {
  expect_refused(base_scene +
                     "script:\n"
                     "  - {name: a, device: spaceball, duration: 1 s, linear: inf 0 0 m/s}\n",
                 9, {"-10 to 10 m/s"});
}

TEST(SceneError, ValuesOutOfTheirRangeAreRefused) {
  expect_refused(base_scene + "rate: 0 Hz\n", 8, {"1 to 1e+05 Hz"});
  expect_refused(base_scene + "network: [{module: kbb2, stiffness: 0 N/m}]\n", 8,
                 {"0.001 to 1e+07 N/m"});
  expect_refused(base_scene + "laws: {a: {range: 0 m}}\n", 8, {"1e-06 to 1000 m"});
  expect_refused(base_scene + "budget: {threads: -1}\n", 8, {"0 to 16"});
  expect_refused(base_scene + "budget: {work: -1}\n", 8, {"0 to 1000000000"});
  expect_refused(base_scene + "budget: {max_age: 0}\n", 8, {"1 to 1000000000"});
  expect_refused(base_scene + "budget: {work: 1.5}\n", 8, {"a whole number"});
  expect_refused(base_scene +
                     "script:\n"
                     "  - {name: a, device: torque_arm, duration: 1 s, direction: 0 0 0, "
                     "lever: 1 rad/s}\n",
                 9, {"'direction' is '0 0 0'"});
  expect_refused(base_scene +
                     "script:\n"
                     "  - {name: a, device: torque_arm, duration: 1 s, direction: 0 0 1, "
                     "lever: 1 rad/s, pitch: 11 m/rad}\n",
                 9, {"'pitch' is '11 m/rad'"});
  expect_refused(base_scene + "script:\n  - {name: a, device: spaceball, duration: 0 s}\n", 9,
                 {"'duration' is '0 s'"});
}

TEST(SceneError, AMissingKeyIsRefusedAtTheMapThatLacksIt) {
  expect_refused(changed("obstacles:\n  - {name: wall, shape: box, size: 1 2 3 m}\n", ""), 1,
                 {"'obstacles' is missing"});
  expect_refused(changed("tool:\n  - {name: rod, shape: sphere, radius: 20 mm}\n", ""), 1,
                 {"'tool' is missing"});
  expect_refused("tool: []\nobstacles: []\n", 1, {"'robot' is missing"});
  expect_refused(changed("  start: 0 45 180 0 45 0 deg\n", ""), 2, {"'start' is missing"});
  expect_refused(changed("  urdf: ../robots/puma560.urdf\n", ""), 2, {"'urdf' is missing"});
  expect_refused(changed("  start:", "  mjcf: ../robots/puma560.urdf\n  start:"), 2,
                 {"'urdf'", "beside 'mjcf'"});
  expect_refused(changed(", radius: 20 mm", ""), 5, {"'radius' is missing"});
  expect_refused(changed("shape: box, ", ""), 7, {"'shape' is missing"});
  expect_refused(changed("name: wall, ", ""), 7, {"'name' is missing"});
  expect_refused(base_scene + "script:\n  - {name: a, duration: 1 s}\n", 9,
                 {"'device' is missing"});
  expect_refused(base_scene + "script:\n  - {name: a, device: spaceball}\n", 9,
                 {"'duration' is missing"});
  expect_refused(
      base_scene + "script:\n  - {name: a, device: torque_arm, duration: 1 s, direction: 1 0 0}\n",
      9, {"'lever' is missing"});
}

TEST(SceneError, AToolWithoutPartsIsRefused) {
  expect_refused(changed("tool:\n  - {name: rod, shape: sphere, radius: 20 mm}", "tool: []"), 4,
                 {"'tool' has no part"});
}

TEST(SceneError, AKeyWithoutAValueIsRefused) {
  expect_refused(changed("  - {name: wall, shape: box, size: 1 2 3 m}\n", ""), 6,
                 {"'obstacles' is empty"});
  expect_refused(changed("radius: 20 mm", "radius: "), 5, {"'radius' is"});
  expect_refused(changed("name: rod", "name: ''"), 5, {"'name' is ''"});
}

TEST(SceneError, AValueOfTheWrongKindIsRefused) {
  expect_refused(
      changed("obstacles:\n  - {name: wall, shape: box, size: 1 2 3 m}", "obstacles: none"), 6,
      {"'obstacles' is 'none'", "a list"});
  expect_refused(base_scene + "laws: [a]\n", 8, {"'laws' is a list", "a map"});
  expect_refused(base_scene + "name: [a]\n", 8, {"'name' is a list", "a text"});
  expect_refused("- a\n- b\n", 1, {"'the scene' is a list"});
  expect_refused("just words\n", 1, {"'the scene' is 'just words'"});
}

TEST(SceneError, AKeyThatStandsTwiceIsRefused) {
  expect_refused(base_scene + "rate: 1 kHz\nrate: 2 kHz\n", 9, {"a second key 'rate'"});
  expect_refused(changed("20 mm", "20 mm, radius: 30 mm"), 5, {"a second key 'radius'"});
}

TEST(SceneError, ANameThatStandsTwiceIsRefused) {
  expect_refused(base_scene + "  - {name: wall, shape: sphere, radius: 1 m}\n", 8,
                 {"'name' is 'wall'"});
  expect_refused(changed("obstacles:", "  - {name: rod, shape: sphere, radius: 1 m}\nobstacles:"),
                 6, {"'name' is 'rod'"});
  expect_refused(base_scene +
                     "script:\n"
                     "  - {name: a, device: spaceball, duration: 1 s}\n"
                     "  - {name: a, device: spaceball, duration: 1 s}\n",
                 10, {"'name' is 'a'"});
  expect_refused(base_scene + "laws:\n  a: {range: 1 m}\n  a: {range: 2 m}\n", 10,
                 {"a second key 'a'"});
}

TEST(SceneError, ALawThatIsNotDefinedIsRefusedAndTheDefinedOnesNamed) {
  expect_refused(changed("size: 1 2 3 m", "size: 1 2 3 m, law: wal") + "laws: {wall: {}}\n", 7,
                 {"'law' is 'wal'", "default, wall"});
}

TEST(SceneError, AnUnknownWordIsRefusedAndTheKnownOnesNamed) {
  expect_refused(changed("shape: box", "shape: cube"), 7,
                 {"'shape' is 'cube'", "box, sphere, capsule, cylinder, cone, ellipsoid, hull"});
  expect_refused(base_scene + "script:\n  - {name: a, device: mouse, duration: 1 s}\n", 9,
                 {"'device' is 'mouse'", "spaceball, torque_arm"});
  expect_refused(
      base_scene + "script:\n  - {name: a, device: spaceball, duration: 1 s, frame: base}\n", 9,
      {"'frame' is 'base'", "world, tool"});
}

TEST(SceneError, ARobotFileThatIsNotThereIsRefused) {
  expect_refused(changed("puma560.urdf", "puma.urdf"), 2, {"none at robots/puma.urdf"});
  expect_refused(changed("../robots/puma560.urdf", "../robots"), 2, {"none at robots"});
}

TEST(SceneError, AdmittanceHasItsRanges) {
  const auto admittance = [](const std::string& text) {
    return changed("tool:", "  admittance: {" + text + "}\ntool:");
  };
  expect_refused(admittance("response: 5 ms"), 4, {"'response'", "0.01 to 1 s"});
  expect_refused(admittance("response: 40"), 4, {"'response'", "ms"});
  expect_refused(admittance("scale: 0"), 4, {"'scale'", "0.001 to 1000"});
  expect_refused(admittance("rest_time: nan s"), 4, {"'rest_time'"});
  expect_refused(admittance("inertia: 2 kg m^2"), 4, {"'inertia'", "response, scale, rest_time"});
  const Scene scene = parsed(admittance("response: 40 ms, scale: 50 %, rest_time: 0.2 s"));
  ASSERT_TRUE(scene.robot.admittance);
  EXPECT_EQ(scene.robot.admittance->response, 0.04);
  EXPECT_EQ(scene.robot.admittance->scale, 0.5);
  EXPECT_EQ(scene.robot.admittance->rest_time, 0.2);
  EXPECT_FALSE(parsed(base_scene).robot.admittance);
}

TEST(SceneError, OnlyASceneWithALineIsApart) {
  expect_refused(changed("tool:", "apart: maybe\ntool:"), 4, {"'apart' is 'maybe'", "yes, no"});
  expect_refused(changed("tool:", "apart: yes\ntool:"), 4, {"two programs", "'line'"});
}

TEST(SceneError, APayloadThatIsNotAllowedIsRefused) {
  const auto payload = [](const std::string& text) {
    return changed("tool:", "  payload: {" + text + "}\ntool:");
  };
  expect_refused(payload("position: 0 0 0 m"), 4, {"'mass' is missing"});
  expect_refused(payload("mass: 100.1 kg"), 4, {"'mass'", "100.1", "0 to 100 kg"});
  expect_refused(payload("mass: -1 g"), 4, {"'mass'", "0 to 100 kg"});
  expect_refused(payload("mass: 2"), 4, {"'mass'", "kg"});
  expect_refused(payload("mass: 2 kg, position: 0 0 10.1 m"), 4, {"'position'", "-10 to 10 m"});
  expect_refused(payload("mass: 2 kg, position: 0 0 nan m"), 4, {"'position'"});
  expect_refused(payload("mass: 2 kg, known: maybe"), 4, {"'known' is 'maybe'", "yes, no"});
  expect_refused(payload("mas: 2 kg"), 4, {"'mas'", "mean 'mass'"});
}

TEST(SceneError, AHullOfTooManyPointsIsRefusedAtItsLine) {
  std::string points = "0 0 0 m";
  for (int i = 0; i < 10000; ++i) points += ", 0 0 0 m";
  expect_refused(changed("shape: box, size: 1 2 3 m", "shape: hull, points: [" + points + "]"), 7,
                 {"hull 'wall'", "1 to 10000"});
  expect_refused(changed("shape: box, size: 1 2 3 m", "shape: hull, points: []"), 7,
                 {"hull 'wall'"});
}

TEST(SceneError, AnEmptyFileIsRefused) {
  expect_refused("", 1, {"the file is empty"});
  expect_refused("# nothing\n", 1, {"the file is empty"});
  expect_refused("\n\n---\n", 1, {"the file is empty"});
}

TEST(SceneError, BrokenYamlIsRefusedAtItsLine) {
  expect_refused(base_scene + "rate: [400 Hz\nname: x\n", 9, {"not YAML"});
  expect_refused(base_scene + "\tname: x\n", 8, {"not YAML"});
  expect_refused(base_scene + "name: *nowhere\n", 8, {"not YAML"});
}

TEST(SceneError, ATextWithANulIsRefusedWhole) {
  expect_refused(base_scene + "network: [{module: \"\\0\"}]\n", 8, {"code 0", "allowed"});
}

TEST(SceneError, ASecondDocumentIsRefused) {
  expect_refused(base_scene + "---\nname: b\n", 9, {"a second YAML document"});
}

TEST(SceneError, EndlessNestingIsRefused) {
  EXPECT_THROW((void)parsed(std::string(100000, '[')), SetupError);
  EXPECT_THROW((void)parsed(std::string(100000, '{')), SetupError);
}

TEST(SceneError, EveryTruncationIsAcceptedOrRefusedButNeverCrashes) {
  int refused = 0;
  for (std::size_t length = 0; length < base_scene.size(); ++length) {
    try {
      (void)parsed(base_scene.substr(0, length));
    } catch (const SetupError&) {
      ++refused;
    }
  }
  EXPECT_GE(refused, static_cast<int>(base_scene.size()) - 2);
}

TEST(SceneError, AFileThatCannotBeReadIsRefused) {
  for (const std::string path : {"scenes/none.yaml", "scenes", "scenes/empty.yaml/x", ""}) {
    try {
      (void)load(path);
      ADD_FAILURE() << path << " was accepted";
    } catch (const SetupError& error) {
      EXPECT_EQ(error.file(), path);
      EXPECT_NE(std::string(error.what()).find("allowed: a scene file"), std::string::npos);
    }
  }
}

}  // namespace scene_error_test
}  // namespace repel::scene
