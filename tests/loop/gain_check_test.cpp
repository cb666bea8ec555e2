// SPDX-License-Identifier: BSD-3-Clause
#include <repel/loop/gain_check.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include <repel/base/setup_error.hpp>

#include "loop/slider.hpp"
#include "support/draws.hpp"
#include "support/families.hpp"

namespace repel {
namespace gain_check_test {

using Jacobian = Eigen::Matrix<double, 6, Eigen::Dynamic>;

/// Rails along x, y and z with these frictions [N s/m].
double damping_of(const std::array<double, 3>& friction, const Jacobian& J) {
  ArmModel model = test::slider_model(1000.0);
  for (std::size_t i = 0; i < 3; ++i) model.links[i].viscous_friction = friction[i];
  return device_damping(model, J);
}

Jacobian rails() {
  Jacobian J = Jacobian::Zero(6, 3);
  J.topRows<3>().setIdentity();
  return J;
}

TEST(GainCheck, DampingIsThatOfTheDirectionInWhichItIsLeast) {
  EXPECT_DOUBLE_EQ(damping_of({5.0, 3.0, 9.0}, rails()), 3.0);
  // Two joints with the same direction are compliant in series, like springs.
  Jacobian shared = rails();
  shared(0, 1) = 1.0;
  shared(1, 1) = 0.0;
  EXPECT_DOUBLE_EQ(damping_of({6.0, 3.0, 9.0}, shared), 2.0);
}

TEST(GainCheck, JointThatTurnsFreelyLeavesNoDamping) {
  EXPECT_EQ(damping_of({5.0, 0.0, 9.0}, rails()), 0.0);
  Jacobian unmoved = rails();
  unmoved.col(1).setZero();  // a joint that does not move the tool has no effect
  EXPECT_DOUBLE_EQ(damping_of({5.0, 0.0, 9.0}, unmoved), 5.0);
}

/// A ball and two walls, 4 and 10 kN/m, with a damping of 10 N s/m each.
World two_walls(GivenAt given_at = GivenAt::part) {
  World world;
  const BodyId tool = world.add_body("tool");
  const PartId ball = world.add_part(tool, "ball", Shape::sphere(0.05));
  for (const double force : {40.0, 100.0}) {
    Pose X = Pose::Identity();
    X.translation().x() = 1.0;
    const PartId wall = world.add_part(World::fixed, "wall of " + to_text(force) + " N",
                                       Shape::box({0.1, 1.0, 1.0}), X);
    world.add_pair(ball, wall,
                   {.range = 0.02, .surface_force = force, .damping = 10.0, .given_at = given_at});
  }
  return world;
}

// It once compared with the friction of the arm alone: 0 N/m for every wall that has more damping
// than the arm has friction, so that each scene switched it off.
TEST(GainCheck, WallThatIsTooStiffIsSaidWithWhatWouldDoAndTheOtherIsNot) {
  const World world = two_walls();
  // 10 N s/m over half a period of 2.5 ms: 8 kN/m.
  const auto said = check_gains(world, 0.0025, 0.0, 0.0, network::GainCheck::warning);
  ASSERT_EQ(said.size(), 1U);
  for (const char* part : {"'wall of 100 N'", "10000 N/m", "8000 N/m", "2.5 ms", "10 N s/m",
                           "needs 12.5 N s/m of damping", "at least 500 Hz"}) {
    EXPECT_NE(said[0].find(part), std::string::npos) << part << '\n' << said[0];
  }
  EXPECT_THROW(check_gains(world, 0.0025, 0.0, 0.0, network::GainCheck::error), SetupError);
  EXPECT_TRUE(check_gains(world, 0.002, 0.0, 0.0, network::GainCheck::error).empty());
}

TEST(GainCheck, LawGivenAtTheToolIsSaidWithItsNumbersAtThePart) {
  for (const GivenAt given_at : {GivenAt::part, GivenAt::tool}) {
    const auto said =
        check_gains(two_walls(given_at), 0.0025, 0.0, 0.0, network::GainCheck::warning);
    ASSERT_EQ(said.size(), 1U);
    EXPECT_EQ(said[0].ends_with("; these are its numbers at the part"), given_at == GivenAt::tool);
  }
}

TEST(GainCheck, FrictionOfTheArmAloneMayDoAsWell) {
  const World world = two_walls();
  // 10 N s/m for the wall itself, 12.5 for its spring.
  EXPECT_TRUE(check_gains(world, 0.0025, 0.0, 22.6, network::GainCheck::error).empty());
  EXPECT_THROW(check_gains(world, 0.0025, 0.0, 22.4, network::GainCheck::error), SetupError);
}

TEST(GainCheck, DelayOfTheDriveLowersTheLimit) {
  const World world = two_walls();
  const auto said = check_gains(world, 0.0011, 1.0, 0.0, network::GainCheck::warning);
  ASSERT_EQ(said.size(), 2U);  // 10 / (2.5 * 1.1 ms): 3.6 kN/m
  EXPECT_NE(said[1].find("drive delay of 1 ticks"), std::string::npos) << said[1];
}

TEST(GainCheck, DampingThatMayRiseIsAtLeastWhatTheWallNeeds) {
  const ForceLaw soft{.range = 0.02, .surface_force = 100.0, .damping_may_rise = true};
  ForceLaw stiff = soft;
  stiff.surface_force = 1000.0;  // 1e5 N/m
  EXPECT_EQ(settled(soft, 0.0025, 0.0).damping, 50.0);
  EXPECT_DOUBLE_EQ(settled(stiff, 0.0025, 0.0).damping, gain_rounding * 125.0);
  EXPECT_DOUBLE_EQ(settled(stiff, 0.0025, 2.0).damping, gain_rounding * 1125.0);
  EXPECT_EQ(complaint(settled(stiff, 0.0025, 2.0), 0.0025, 2.0), "");
  stiff.damping = 3.0;
  stiff.damping_may_rise = false;
  EXPECT_EQ(settled(stiff, 0.0025, 2.0).damping, 3.0);
}

TEST(GainCheck, UsualDampingIsOpenUnlessItIsMeant) {
  ForceLaw stiff{.range = 0.02, .surface_force = 1000.0};
  EXPECT_DOUBLE_EQ(settled(stiff, 0.0025, 0.0).damping, gain_rounding * 125.0);
  stiff.damping_is_meant = true;
  EXPECT_EQ(settled(stiff, 0.0025, 0.0).damping, ForceLaw::usual_damping);
}

/// The number behind some words of a text; NaN if they are not there.
double number_behind(const std::string& words, const std::string& text) {
  const std::size_t at = text.find(words);
  return at == std::string::npos ? std::nan("") : std::stod(text.substr(at + words.size()));
}

// The numbers were rounded to the nearest, and half of them refused again.
TEST(GainCheck, WhoFollowsItsAdviceIsNotRefusedAgain) {
  constexpr unsigned seed = 610;
  families::Rng rng(seed);
  int rates = 0, none = 0;
  for (int trial = 0; trial < families::draws(3000); ++trial) {
    SCOPED_TRACE(families::of_seed(seed, "trial", trial));
    const double period = 1.0 / families::log_uniform(rng, 50.0, 5000.0);
    const double response = trial % 2 == 0 ? 0.0 : families::log_uniform(rng, 1e-3, 0.1);
    const double ticks = trial % 3 == 0 ? 0.0 : families::uniform(rng, 0.0, 4.0);
    const double delay = ticks + response / period;
    ForceLaw law{.range = families::log_uniform(rng, 1e-3, 0.1),
                 .surface_force = families::log_uniform(rng, 1.0, 1e4),
                 .damping = families::log_uniform(rng, 0.1, 1e4)};
    const std::string said = complaint(law, period, delay, response);
    if (said.empty()) continue;
    ForceLaw followed = law;
    followed.damping = number_behind("this wall needs ", said);
    EXPECT_EQ(complaint(followed, period, delay, response), "") << said;
    followed = law;
    followed.surface_force = 0.5 * followed.range * number_behind("the limit is ", said);
    EXPECT_EQ(complaint(followed, period, delay, response), "") << said;
    const double rate = number_behind("a rate of at least ", said);
    if (rate > 0.0) {
      ++rates;
      EXPECT_LE(rate, greatest_rate);
      EXPECT_EQ(complaint(law, 1.0 / rate, ticks + response * rate, response), "") << said;
    } else {
      ++none;
      EXPECT_NE(said.find("no rate would do"), std::string::npos) << said;
      const double answer = 1e-3 * number_behind("answers within ", said);
      if (answer > 0.0) {
        EXPECT_EQ(complaint(law, period, ticks + answer / period, answer), "") << said;
      }
      EXPECT_NE(complaint(law, 1.0 / greatest_rate, ticks + response * greatest_rate, response),
                "");
    }
  }
  EXPECT_GT(rates, families::draws(3000) / 20);
  EXPECT_GT(none, families::draws(3000) / 20);
}

}  // namespace gain_check_test
}  // namespace repel
