#include <repel/network/multiplex.hpp>

#include <gtest/gtest.h>

#include "support/families.hpp"

namespace repel::network {
namespace {

constexpr unsigned seed = 3;

TEST(Multiplex, PowerFactorIsTheRatioOfTheScales) {
  families::Rng random(seed);
  for (int i = 0; i < 1000; ++i) {
    const Multiplex transformer{families::direction(random), families::uniform(random, 0.01, 2.0),
                                families::uniform(random, 0.01, 2.0)};
    const double rate = families::uniform(random, -3.0, 3.0);
    const Vec3 force = families::uniform(random, 0.0, 100.0) * families::direction(random);
    const double to_tool = force.dot(transformer.flow(rate).linear);
    const double to_lever = transformer.effort(force) * rate;
    const double factor = transformer.force_scale / transformer.velocity_scale;
    EXPECT_NEAR(to_lever, factor * to_tool, 1e-12 * (1.0 + std::abs(to_lever))) << "seed " << seed;
  }
}

TEST(Multiplex, PassesAllPowerOnWhenTheScalesAreEqual) {
  families::Rng random(seed);
  for (int i = 0; i < 1000; ++i) {
    const double scale = families::log_uniform(random, 1e-3, 10.0);
    const Multiplex transformer{families::direction(random), scale, scale};
    const double rate = families::uniform(random, -3.0, 3.0);
    const Vec3 force = families::uniform(random, 0.0, 100.0) * families::direction(random);
    const double to_tool = power({force, Vec3::Zero()}, transformer.flow(rate));
    const double to_lever = transformer.effort(force) * rate;
    EXPECT_NEAR(to_lever, to_tool, 1e-12 * (1.0 + std::abs(to_tool))) << "seed " << seed;
  }
}

TEST(Multiplex, DrivesAlongItsDirectionAndDoesNotTurnTheTool) {
  const Multiplex transformer{Vec3(0.0, 0.6, 0.8), 0.1, 0.1};
  const Twist V = transformer.flow(2.0);
  EXPECT_LE((V.linear - Vec3(0.0, 0.12, 0.16)).norm(), 1e-15);
  EXPECT_EQ(V.angular, Vec3::Zero());
  EXPECT_EQ(transformer.effort({7.0, 0.0, 0.0}), 0.0);  // across: not felt
}

}  // namespace
}  // namespace repel::network
