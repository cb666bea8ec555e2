// SPDX-License-Identifier: BSD-3-Clause
// The program led by a hand at a force-reflecting handle, whose service is a stand-in with a device
// and a hand of its own. By the clock.
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <string>

#include <devices/fake_haply.hpp>
#include <end_to_end/teleop.hpp>
#include <end_to_end/undisturbed.hpp>

namespace repel::test {
namespace haply_test {

using devices::FakeHandle;
using nlohmann::json;

/// A handle of 0.1 kg, and a hand that holds it and moves down, waits and comes up again. In axes
/// of the device: z is up.
class Hand {
 public:
  static constexpr double depth = 0.04;  ///< [m]

  /// The force of the last command has acted until now.
  void feel(const Vec3& force, FakeHandle& handle) {
    const auto now = std::chrono::steady_clock::now();
    if (!begun_) begin_ = last_ = now;
    begun_ = true;
    const double passed = std::chrono::duration<double>(now - last_).count();
    last_ = now;
    longest_ = std::max(longest_, passed);
    for (double t = 0.0; t < std::min(passed, 0.05); t += 1e-4) {
      const Vec3 wanted = at_first_ - Vec3(0, 0, depth) * share();
      const Vec3 hand = 200.0 * (wanted - handle.position) - 8.0 * handle.velocity;
      handle.velocity += 1e-4 / 0.1 * (hand + held_);
      handle.position += 1e-4 * handle.velocity;
    }
    held_ = force;
    const double up = force.z();
    most_ = std::max(most_, force.norm());
    if (share() == 1.0) most_up_ = std::max(most_up_, up);
    if (time() < 0.9) most_at_first_ = std::max(most_at_first_, force.norm());
    lowest_ = std::min(lowest_, handle.position.z() - at_first_.z());
  }

  double most_ = 0.0;           // [N]
  double most_up_ = 0.0;        // [N] while it was down
  double most_at_first_ = 0.0;  // [N] before it moved
  double lowest_ = 0.0;         // [m]
  double longest_ = 0.0;        // [s] between two commands

 private:
  [[nodiscard]] double time() const {
    return std::chrono::duration<double>(last_ - begin_).count();
  }
  [[nodiscard]] double share() const {
    const double t = time();
    return std::clamp(t < 4.0 ? (t - 1.0) / 2.0 : (6.0 - t) / 2.0, 0.0, 1.0);
  }

  Vec3 at_first_ = FakeHandle{}.position;
  std::chrono::steady_clock::time_point begin_, last_;
  Vec3 held_{0, 0, 0};
  bool begun_ = false;
};

std::string scene_text(const std::string& grip) {
  return "name: led\nrate: 400 Hz\n" + robot_text() + table_text() +
         "network:\n"
         "  - {module: six_axes, motion_scale: 2, hand_stiffness: 300 N/m, " +
         grip +
         "}\n"
         "  - {module: relief}\n"
         "  - {module: kbb2}\n"
         "  - {module: obstacle}\n"
         "  - {module: puma_kin}\n"
         "  - {module: limits}\n"
         "  - {module: puma_joints}\n";
}

TEST(Haply, AHandLeadsTheToolIntoAWallAndFeelsIt) {
  const Folder folder;
  const std::string scene = folder.with("led.yaml", scene_text("hand_damping: 0.8 N s/m"));
  Hand hand;
  Columns log;
  const std::vector<json> reports = undisturbed([&]() -> std::vector<json> {
    hand = Hand();
    devices::FakeHaply service;
    service.feel_by([&](const Vec3& force, FakeHandle& handle) { hand.feel(force, handle); });
    const Ending ending = teleop(
        quoted(scene) + " --seconds 7.5 --backend ideal --device haply:" + service.url() +
        " --log " + quoted(folder / "log.csv") + " --report " + quoted(folder / "report.json"));
    EXPECT_EQ(ending.status, 0) << ending;
    EXPECT_TRUE(service.force().isZero(0.0)) << "it is let go at the end";
    EXPECT_LE(hand.most_, 3.0 + 1e-4);
    log = columns_of(folder / "log.csv");
    json report = report_of(folder / "report.json");
    EXPECT_EQ(report.at("allocations_in_tick"), 0);
    // A hand that got no time for so long pushes otherwise, though no tick was lost.
    if (hand.longest_ > 0.02) report["skipped_ticks"] = 1;
    for (const json& module : report.at("modules")) {
      if (!module.at("claims_passive").get<bool>()) continue;
      EXPECT_LE(module.at("deficit"), 1e-9) << module;
    }
    return {report};
  });
  if (reports.empty()) GTEST_SKIP() << stood_still;
  const auto& z = log.at("z_m");
  const double sunk = z.front() - *std::min_element(z.begin(), z.end());
  // Without the table it would sink twice as far as the hand.
  EXPECT_LT(hand.lowest_, -0.01);
  EXPECT_GT(sunk, 0.01);
  // Hand, grip and wall come to rest at 2.011 N; less if the machine stood still on the way there.
  EXPECT_NEAR(reports[0].at("peak_force_n"), 2.01, 0.1);
  EXPECT_GT(hand.most_up_, 1.0);
  EXPECT_LT(hand.most_at_first_, 0.3);
  EXPECT_NEAR(z.back(), z.front(), 0.5 * sunk) << "it comes back with the hand";
}

// The handle is at the station, table and arm at the site, 20 ms away.
TEST(Haply, AHandFeelsATableInAnotherProgram) {
  const Folder folder;
  const std::string scene = folder.with(
      "far.yaml",
      "name: far\nrate: 400 Hz\n" + robot_text() + table_text() +
          "network:\n"
          "  - {module: six_axes, motion_scale: 2, hand_stiffness: 300 N/m, "
          "hand_damping: 0.8 N s/m}\n"
          "  - {module: line, delay: 20 ms, jitter: 3 ms, loss: 2 %, impedance: 20 N s/m, "
          "angular_impedance: 0.2 N m s/rad}\n"
          "  - {module: kbb2, shunt: 20 N s/m, angular_shunt: 0.2 N m s/rad}\n"
          "  - {module: obstacle}\n"
          "  - {module: puma_kin}\n"
          "  - {module: limits}\n"
          "  - {module: puma_joints}\n");
  Hand hand;
  const std::vector<json> sides = undisturbed([&]() -> std::vector<json> {
    hand = Hand();
    devices::FakeHaply service;
    service.feel_by([&](const Vec3& force, FakeHandle& handle) { hand.feel(force, handle); });
    const Ending ending =
        teleop(quoted(scene) + " --programs two --seconds 8 --backend ideal --device haply:" +
               service.url() + " --link udp:127.0.0.1:" + std::to_string(22000 + getpid() % 20000) +
               " --report " + quoted(folder / "report.json"));
    EXPECT_EQ(ending.status, 0) << ending;
    EXPECT_TRUE(service.force().isZero(0.0)) << "it is let go at the end";
    EXPECT_LE(hand.most_, 3.0 + 1e-4);
    const json site = report_of(folder / "report.json");
    const json& station = site.at("station");
    for (const json& side : {site, station}) {
      EXPECT_EQ(side.at("allocations_in_tick"), 0);
      for (const json& module : side.at("modules")) {
        EXPECT_EQ(module.at("passive"), module.at("claims_passive")) << module;
      }
    }
    return {site, station};
  });
  if (sides.empty()) GTEST_SKIP() << stood_still;
  SCOPED_TRACE(sides[0].dump());
  EXPECT_GT(sides[0].at("peak_force_n"), 1.0);
  EXPECT_GT(sides[1].at("peak_hand_force_n"), 1.0);
  EXPECT_GT(hand.most_up_, 0.5);
}

TEST(Haply, AGripThatNoDeviceCanKeepPassiveIsRefused) {
  const Folder folder;
  const std::string scene = folder.with("led.yaml", scene_text("hand_damping: 30 N s/m"));
  devices::FakeHaply service;
  const Ending ending = teleop(quoted(scene) + " --seconds 1 --device haply:" + service.url());
  EXPECT_EQ(ending.status, 1) << ending;
  EXPECT_TRUE(ending.says("hand_damping: 0.825 N s/m")) << ending;
}

TEST(Haply, WithoutAServiceTheProgramSaysHowToGetIt) {
  std::string url;
  {
    const devices::FakeHaply gone;
    url = gone.url();
  }
  const Ending ending = teleop("six_axes --seconds 1 --device haply:" + url);
  EXPECT_EQ(ending.status, 1) << ending;
  EXPECT_TRUE(ending.says("systemctl start haply-inverse-service")) << ending;
}

}  // namespace haply_test
}  // namespace repel::test
