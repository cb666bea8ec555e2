// SPDX-License-Identifier: BSD-3-Clause
// The live view of a link that only looks like something: no part of it is in the world, so that no
// body of the world says where it is.
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <repel/robots/urdf.hpp>
#include <repel/world/kinematics.hpp>

#include "end_to_end/live.hpp"

namespace repel::test::bare_link_test {

void replace(std::string& text, const std::string& old, const std::string& with) {
  const std::size_t at = text.find(old);
  ASSERT_NE(at, std::string::npos) << old;
  text.replace(at, old.size(), with);
}

/// The PUMA, whose upper arm, link 1 of the chain, has its three boxes as looks only.
std::string bare_puma() {
  std::string text = text_of(REPEL_SOURCE "/robots/puma560.urdf");
  const std::size_t begin = text.find("<link name=\"link_2\">");
  const std::size_t end = text.find("</link>", begin);
  std::string link = text.substr(begin, end - begin);
  for (std::size_t at = 0; (at = link.find("collision", at)) != std::string::npos;) {
    link.replace(at, 9, "visual");
  }
  return text.replace(begin, end - begin, link);
}

/// A scene of this project, whose last arm is that robot.
std::string scene_in(const Folder& folder, const std::string& name) {
  const std::string urdf = folder.with("bare.urdf", bare_puma());
  std::string text = text_of(std::string(REPEL_SOURCE "/scenes/") + name + ".yaml");
  const std::string puma = "../robots/puma560.urdf";
  const std::size_t last = text.rfind(puma);
  text.replace(last, puma.size(), urdf);
  if (text.find(puma) != std::string::npos)
    replace(text, puma, REPEL_SOURCE "/robots/puma560.urdf");
  return folder.with(name + ".yaml", text);
}

/// The second arm of the scene `two_arms`, as it stands there.
ArmModel right_arm(const Folder& folder) {
  ArmModel arm = load_arm(folder / "bare.urdf").arm;
  arm.X_WB =
      Eigen::Translation3d(1.5, -0.3, 0.0) * Eigen::AngleAxisd(std::numbers::pi, Vec3::UnitZ());
  return arm;
}

std::vector<double> joints_of(const Json& frame, std::size_t arm) {
  return frame.at("arms")[arm].at("q").get<std::vector<double>>();
}

double difference(const std::vector<double>& a, const std::vector<double>& b) {
  double most = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
  return most;
}

void expect_pose(const Json& told, const Pose& is) {
  ASSERT_EQ(told.size(), 7U);
  Pose X = Pose::Identity();
  X.translation() = Vec3(told[0].get<double>(), told[1].get<double>(), told[2].get<double>());
  X.linear() = Eigen::Quaterniond(told[6].get<double>(), told[3].get<double>(),
                                  told[4].get<double>(), told[5].get<double>())
                   .normalized()
                   .toRotationMatrix();
  // 1e-6, and the joint positions of a frame are rounded to half of it: the link is at two of them.
  EXPECT_LT((X.translation() - is.translation()).norm(), 2e-6);
  EXPECT_LT((X.linear() - is.linear()).norm(), 4e-6);
}

/// Of a page of two_arms, until the second arm has moved.
void expect_link_moves(LivePage& page, const Folder& folder) {
  const Json scene = page.await("scene");
  ASSERT_FALSE(scene.is_null());
  EXPECT_FALSE(scene.at("arms")[0].contains("links")) << "its links have bodies";
  EXPECT_EQ(scene.at("arms")[1].at("links"), Json::parse("[1]"));
  int boxes = 0;
  for (const Json& each : scene.at("visuals")) {
    EXPECT_NE(each.contains("link"), each.contains("body")) << each.at("name");
    if (!each.contains("link")) continue;
    ++boxes;
    EXPECT_EQ(each.at("link"), 1);
    EXPECT_EQ(each.at("arm"), 1);
    EXPECT_EQ(each.at("name"), "link_2");
    EXPECT_NEAR(each.at("pose")[2].get<double>(), 0.2435, 1e-9) << "in the link";
  }
  EXPECT_EQ(boxes, 3);
  int bodies = 0;
  for (const Json& body : scene.at("bodies")) {
    bodies += body.get<std::string>().find("link_2") != std::string::npos ? 1 : 0;
  }
  EXPECT_EQ(bodies, 1) << "that of the first arm";
  const Json first = page.await("frame");
  ASSERT_FALSE(first.is_null());
  const Json moved = page.await("frame", [&](const Json& frame) {
    return difference(joints_of(frame, 1), joints_of(first, 1)) > 0.1;
  });
  ASSERT_FALSE(moved.is_null());
  Kinematics kinematics(right_arm(folder));
  for (const Json& frame : {first, moved}) {
    EXPECT_FALSE(frame.at("arms")[0].contains("links"));
    ASSERT_EQ(frame.at("arms")[1].at("links").size(), 1U);
    kinematics.update(joints_of(frame, 1));
    expect_pose(frame.at("arms")[1].at("links")[0], kinematics.X_WL(1));
  }
}

TEST(BareLink, IsShownWhereTheKinematicsHasIt) {
  const Folder folder;
  LiveTeleop program({scene_in(folder, "two_arms")});
  LivePage page(program);
  expect_link_moves(page, folder);
  EXPECT_EQ(program.interrupt().status, 0);
}

TEST(BareLink, IsShownInAReplay) {
  const Folder folder;
  const std::string log = folder / "run.mcap";
  const Ending ending =
      teleop(quoted(scene_in(folder, "two_arms")) + " --fast --seconds 6 --log " + quoted(log));
  ASSERT_EQ(ending.status, 0) << ending;
  LiveTeleop program({"replay", log});
  LivePage page(program);
  expect_link_moves(page, folder);
}

TEST(BareLink, IsShownAtAStation) {
  const Folder folder;
  const std::string scene = scene_in(folder, "remote");
  const std::string link = "udp:127.0.0.1:" + std::to_string(22000 + (getpid() + 9000) % 20000);
  LiveTeleop station({"station", scene, "--impaired", "--link", link});
  LiveTeleop site({"site", scene, "--impaired", "--link", link});
  LivePage page(station);
  EXPECT_EQ(page.await("scene").at("arms")[0].at("links"), Json::parse("[1]"));
  const auto is_told = [](const Json& frame) { return !has_status(frame, "silent_site"); };
  const Json first = page.await("frame", is_told);
  ASSERT_FALSE(first.is_null());
  const Json moved = page.await("frame", [&](const Json& frame) {
    return is_told(frame) && difference(joints_of(frame, 0), joints_of(first, 0)) > 0.02;
  });
  ASSERT_FALSE(moved.is_null());
  Kinematics kinematics(load_arm(folder / "bare.urdf").arm);
  kinematics.update(joints_of(moved, 0));
  expect_pose(moved.at("arms")[0].at("links")[0], kinematics.X_WL(1));
}

}  // namespace repel::test::bare_link_test
