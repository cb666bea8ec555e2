// SPDX-License-Identifier: BSD-3-Clause
#include <repel/world/body_state.hpp>

#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <map>

#include <repel/world/loose_parts.hpp>

namespace repel {
namespace {

BodyState loose(double there, double grip, BodyId holder = {}) {
  BodyState body;
  body.is_loose = true;
  body.presence.there = {there, there, 0.0};
  body.presence.grip = {grip, grip, 0.0};
  body.presence.holder = holder;
  if (grip > 0.0) body.arm = holder;
  return body;
}
BodyState of_arm(BodyId tool, bool spares_held) {
  BodyState body;
  body.arm = tool;
  body.spares_held = spares_held;
  return body;
}

constexpr BodyId tool{1}, other_tool{2};

TEST(ShareBetween, IsAllBetweenBodiesThatStay) {
  const Share share = share_between({}, of_arm(tool, true));
  EXPECT_EQ(share.now, 1.0);
  EXPECT_EQ(share.before, 1.0);
}

TEST(ShareBetween, OfAFreePartIsWithArmsOnly) {
  const BodyState part = loose(0.25, -1.0);
  EXPECT_EQ(share_between(part, of_arm(tool, true)).now, 0.25);
  EXPECT_EQ(share_between(of_arm(tool, false), part).now, 0.25);
  EXPECT_EQ(share_between(part, {}).now, 0.0);
  EXPECT_EQ(share_between(part, loose(1.0, -1.0)).now, 0.0);
}

TEST(ShareBetween, OfAHeldPartIsWithAllButItsHand) {
  const BodyState part = loose(1.0, 1.0, tool);
  EXPECT_EQ(share_between(part, of_arm(tool, true)).now, 0.0);
  EXPECT_EQ(share_between(part, of_arm(tool, false)).now, 1.0) << "a link far from the hand";
  EXPECT_EQ(share_between(part, of_arm(other_tool, true)).now, 1.0);
  EXPECT_EQ(share_between(part, {}).now, 1.0);
  EXPECT_EQ(share_between(part, loose(1.0, -1.0)).now, 1.0) << "one that lies free";
  EXPECT_EQ(share_between(part, loose(1.0, 1.0, tool)).now, 0.0) << "in the same hand";
  EXPECT_EQ(share_between(part, loose(1.0, 1.0, other_tool)).now, 1.0);
}

// However parts come, change hands and go over some time, no share of a force has a step, and
// none is forgotten.
TEST(ShareBetween, HasNoSteps) {
  constexpr double dt = 1e-3;
  constexpr double over = 0.1;
  Motion motion;
  motion.bodies.resize(7);
  motion.bodies[1] = of_arm(tool, true);
  motion.bodies[2] = of_arm(other_tool, true);
  motion.bodies[3] = of_arm(tool, false);
  detail::LooseParts parts;
  for (const int i : {4, 5, 6}) {
    motion.bodies[i].is_loose = true;
    parts.reserve({i}, {i}, 0.1);
  }
  const auto at = [](double x) { return Pose(Eigen::Translation3d(x, 0, 0)); };
  std::array<std::array<double, 7>, 7> last{};  // nothing is there yet
  int changed = 0;
  const std::map<int, std::function<bool()>> changes{
      {10, [&] { return parts.add(motion, {4}, at(0.1), over); }},
      {40, [&] { return parts.add(motion, {5}, at(0.2), over); }},
      {60, [&] { return parts.add(motion, {6}, at(0.3), over); }},
      {70, [&] { return parts.attach(motion, {4}, tool, over); }},
      {150, [&] { return parts.attach(motion, {5}, tool, over); }},
      {160, [&] { return parts.attach(motion, {6}, other_tool, over); }},
      {400, [&] { return parts.release(motion, {4}, over); }},
      {450, [&] { return parts.remove(motion, {5}, over); }},
      {470, [&] { return parts.release(motion, {6}, over); }},
      {700, [&] { return parts.remove(motion, {4}, over); }},
  };
  for (int k = 0; k < 1000; ++k) {
    const auto change = changes.find(k);
    if (change != changes.end()) {
      EXPECT_TRUE(change->second()) << "tick " << k;
    }
    parts.advance(motion, dt);
    for (int i = 0; i < 7; ++i) {
      for (int j = 4; j < 7; ++j) {
        if (i == j) continue;
        const Share now = share_between(motion.bodies[i], motion.bodies[j]);
        const Share back = share_between(motion.bodies[j], motion.bodies[i]);
        EXPECT_EQ(now.now, back.now);
        EXPECT_EQ(now.before, back.before);
        EXPECT_NEAR(now.before, last[i][j], 1e-300)
            << "bodies " << i << " and " << j << ", tick " << k;
        EXPECT_GE(now.now, 0.0);
        EXPECT_LE(now.now, 1.0);
        // Two ramps may run at once.
        EXPECT_LE(std::abs(now.now - last[i][j]), 2.0 * dt / over + 1e-12)
            << "bodies " << i << " and " << j << ", tick " << k;
        changed += now.now != last[i][j] ? 1 : 0;
        last[i][j] = now.now;
      }
    }
  }
  EXPECT_GT(changed, 1000) << "the sample has to mean something";
}

TEST(CarrierOf, IsTheToolThatHolds) {
  Motion motion;
  motion.bodies = {{}, of_arm(tool, true), loose(1.0, 0.5, tool), loose(1.0, -0.5, tool)};
  EXPECT_EQ(carrier_of(motion, {0}), BodyId{0});
  EXPECT_EQ(carrier_of(motion, {1}), BodyId{1});
  EXPECT_EQ(carrier_of(motion, {2}), tool);
  EXPECT_EQ(carrier_of(motion, {3}), BodyId{3}) << "not yet held";
}

}  // namespace
}  // namespace repel
