// SPDX-License-Identifier: BSD-3-Clause
// A scene whose arm comes from an MJCF file, from the scene to its recording.
#include <repel/robots/mjcf.hpp>

#include "end_to_end/teleop.hpp"

namespace repel::test {
namespace mjcf_arm_test {

constexpr char elbow_arm[] = R"(<mujoco model="elbow">
<compiler angle="degree"/>
<default><joint damping="2" armature="0.2" range="-170 170" limited="true"/></default>
<worldbody><geom type="plane" size="5 5 0.1"/>
<body name="base"><geom type="cylinder" size="0.1 0.1" pos="0 0 0.1"/>
<body name="column" pos="0 0 0.4"><joint name="j1" axis="0 0 1"/>
<geom type="capsule" size="0.06" fromto="0 0 0 0 0 0.1"/>
<body name="upper" pos="0 0 0.1"><joint name="j2" axis="0 1 0"/>
<geom type="capsule" size="0.05" fromto="0 0 0 0 0 0.4"/>
<body name="fore" pos="0 0 0.4"><joint name="j3" axis="0 1 0"/>
<geom type="capsule" size="0.04" fromto="0 0 0 0 0 0.4"/>
<body name="wrist" pos="0 0 0.4"><joint name="j4" axis="0 0 1"/><joint name="j5" axis="0 1 0"/>
<joint name="j6" axis="0 0 1"/><geom type="box" size="0.03 0.03 0.05"/>
<site name="tcp" pos="0 0 0.1" zaxis="0 0 1"/>
</body></body></body></body></body></worldbody></mujoco>
)";

std::string scene_of(const std::string& robot) {
  return "robot: {" + robot +
         ", start: 0 30 90 0 60 0 deg, links: []}\ntool:\n"
         "  - {name: rod, shape: capsule, radius: 15 mm, length: 60 mm, position: 0 0 -30 mm}\n"
         "laws:\n  default: {range: 20 mm, surface_force: 40 N, damping: 8 N s/m}\nobstacles:\n"
         "  - {name: table, shape: box, size: 0.6 0.8 0.05 m, position: 0.6 0 0.2 m}\n" +
         push_text();
}

TEST(MjcfArm, PressesOnATableAndItsRecordingRepeats) {
  if (!reads_mjcf()) GTEST_SKIP() << "built without MuJoCo";
  const Folder folder;
  (void)folder.with("elbow.xml", elbow_arm);
  const std::string scene =
      quoted(folder.with("scene.yaml", scene_of("mjcf: elbow.xml, tip_link: tcp")));
  const std::string log = quoted(folder / "run.mcap");
  const std::string report = " --report " + quoted(folder / "r.json");
  const Ending ending =
      teleop(scene + " --backend reference --fast --seconds 2 --log " + log + report);
  ASSERT_EQ(ending.status, 0) << ending;
  EXPECT_FALSE(report_of(folder / "r.json").at("status_ticks").contains("bad_joints")) << ending;
  const Ending again = teleop("replay " + log + report);
  ASSERT_EQ(again.status, 0) << again;
  EXPECT_EQ(report_of(folder / "r.json").at("replay").at("same"), 800) << again;
}

TEST(MjcfArm, TheOtherFormatIsTold) {
  if (!reads_mjcf()) GTEST_SKIP() << "built without MuJoCo";
  const Folder folder;
  (void)folder.with("elbow.xml", elbow_arm);
  const Ending urdf = teleop(quoted(folder.with("u.yaml", scene_of("urdf: elbow.xml"))));
  EXPECT_EQ(urdf.status, 1);
  EXPECT_TRUE(urdf.says("this is MJCF")) << urdf;
  const Ending mjcf =
      teleop(quoted(folder.with("m.yaml", scene_of("mjcf: " REPEL_SOURCE "/robots/puma560.urdf"))));
  EXPECT_EQ(mjcf.status, 1);
  EXPECT_TRUE(mjcf.says("this is URDF")) << mjcf;
}

}  // namespace mjcf_arm_test
}  // namespace repel::test
