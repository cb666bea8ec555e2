// SPDX-License-Identifier: BSD-3-Clause
#include <repel/geometry/tangents.hpp>

#include <gtest/gtest.h>

#include <limits>

#include <support/families.hpp>

namespace repel {
namespace tangents_test {

using families::Rng;

constexpr unsigned seed = 2207;

TEST(Tangents, TheNearestLeavesADepthThatIsExactButForTheSagitta) {
  Rng rng(seed);
  const Tangents cylinder(1.0, 0.0, 0.5);
  const Tangents cone(0.8, 0.6, 0.3);
  for (int i = 0; i < 100000; ++i) {
    const Vec3 x = families::log_uniform(rng, 1e-3, 1.0) * families::direction(rng);
    const double rho = std::hypot(x.x(), x.y());
    const auto depth = [&](const Tangents& t, std::uint32_t name) {
      return t.offset() - dot(t.normal(name), Vec<double>(x));
    };
    for (const Tangents* t : {&cylinder, &cone}) {
      const std::uint32_t name = t->nearest(Vec<double>(x));
      ASSERT_LT(name, t->size());
      const double exact = t == &cone ? 0.3 - 0.8 * rho - 0.6 * x.z() : 0.5 - rho;
      EXPECT_GE(depth(*t, name), exact - 1e-15);
      EXPECT_LE(depth(*t, name), exact + Tangents::sagitta(rho) + 1e-15) << "seed " << seed;
      for (const std::uint32_t step : {1U, t->size() - 1U}) {
        EXPECT_LE(depth(*t, name), depth(*t, (name + step) % t->size()) + 1e-15);
      }
      const auto around = t->around(Vec<double>(x));
      EXPECT_EQ(around[1], (around[0] + 1) % t->size());
      EXPECT_TRUE(name == around[0] || name == around[1]);
    }
  }
}

TEST(Tangents, AreUnitAndExactOnTheAxes) {
  const Tangents cylinder(1.0, 0.0, 0.5);
  for (const Vec3& axis : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(-1, 0, 0), Vec3(0, -1, 0)}) {
    EXPECT_EQ(to_vec3(cylinder.normal(cylinder.nearest(Vec<double>(axis)))), axis);
  }
  for (std::uint32_t i = 0; i < cylinder.size(); i += 977) {
    EXPECT_NEAR(to_vec3(cylinder.normal(i)).norm(), 1.0, 3e-16);
  }
}

TEST(Tangents, APointOnTheAxisOrNotANumberHasSomeTangent) {
  const Tangents cone(0.8, 0.6, 0.3);
  const double none = std::numeric_limits<double>::quiet_NaN();
  const double far = std::numeric_limits<double>::infinity();
  for (const double x : {0.0, none, far, -far}) {
    EXPECT_LT(cone.nearest({x, x, 0.0}), cone.size());
    EXPECT_LT(cone.around({x, x, 0.0})[1], cone.size());
  }
  EXPECT_EQ(Tangents().size(), 0U);
}

}  // namespace tangents_test
}  // namespace repel
