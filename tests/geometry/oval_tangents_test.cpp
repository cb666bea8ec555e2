// SPDX-License-Identifier: BSD-3-Clause
#include <repel/geometry/oval_tangents.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include <support/ellipsoid.hpp>
#include <support/families.hpp>

namespace repel {
namespace oval_tangents_test {

using families::Rng;

constexpr unsigned seed = 1609;

Vec3 random_axes(Rng& rng, double oblong) {
  Vec3 axes(1.0, families::log_uniform(rng, 1.0 / oblong, 1.0), 1.0 / oblong);
  std::shuffle(axes.data(), axes.data() + 3, rng);
  return axes;
}

TEST(OvalTangents, TouchTheEllipsoid) {
  Rng rng(seed);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 axes = random_axes(rng, families::log_uniform(rng, 1.0, 1e4));
    const OvalTangents planes(axes);
    const auto name = static_cast<std::uint32_t>(rng() % planes.size());
    const Vec3 n = to_vec3(planes.normal(name));
    EXPECT_NEAR(n.norm(), 1.0, 4e-16);
    EXPECT_NEAR(planes.offset(name), axes.cwiseProduct(n).norm(), 1e-15)
        << families::of_seed(seed, "plane", i);
  }
}

TEST(OvalTangents, TheNearestLeavesADepthThatIsExactButForTheSagitta) {
  Rng rng(seed);
  for (int i = 0; i < 4000; ++i) {
    SCOPED_TRACE(families::of_seed(seed, "point", i));
    const double oblong = families::log_uniform(rng, 1.0001, 1e4);
    const Vec3 axes = random_axes(rng, oblong);
    const OvalTangents planes(axes);
    Vec3 x = families::log_uniform(rng, 1e-3, 3.0) * axes.cwiseProduct(families::direction(rng));
    if (i % 4 == 0) x[i / 4 % 3] = 0.0;
    const std::uint32_t name = planes.nearest(Vec<double>(x));
    ASSERT_LT(name, planes.size());
    const double depth = planes.offset(name) - to_vec3(planes.normal(name)).dot(x);
    const auto exact =
        static_cast<double>(-oracle::distance_from_ellipsoid(axes, oracle::exact(x)));
    EXPECT_GE(depth, exact - 1e-15);
    // Outside, the height also falls with the angle of the normal.
    const double turned = std::max(0.0, -exact) * oblong * oblong;
    EXPECT_LE(depth, exact + (1.0 + turned) * planes.sagitta() + 1e-15);
  }
}

TEST(OvalTangents, AnyPointHasANearest) {
  const OvalTangents planes(Vec3(0.3, 0.2, 0.1));
  const double none = std::numeric_limits<double>::quiet_NaN();
  const double far = std::numeric_limits<double>::infinity();
  for (const double x : {0.0, none, far, -far, 1e200, -1e-300}) {
    for (const Vec3& p : {Vec3(x, x, x), Vec3(x, 0, 0), Vec3(0, 0, x)}) {
      EXPECT_LT(planes.nearest(Vec<double>(p)), planes.size());
      EXPECT_LT(planes.behind(Vec<double>(p)), planes.size());
    }
  }
  EXPECT_EQ(OvalTangents().size(), 0U);
}

}  // namespace oval_tangents_test
}  // namespace repel
