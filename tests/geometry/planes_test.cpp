// SPDX-License-Identifier: BSD-3-Clause
#include <repel/geometry/planes.hpp>

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include <repel/geometry/facets.hpp>
#include <support/families.hpp>

namespace repel {
namespace planes_test {

using families::Rng;

constexpr unsigned seed = 905;

TEST(Planes, TheNearestIsTheFirstOfTheLeastDeep) {
  Rng rng(seed);
  for (int count = 4; count <= 40; ++count) {
    const std::vector<Vec3> points = families::cloud(rng, count, 1.0).vertices;
    const std::vector<Facet> facets = hull_facets(points);
    const Planes planes(facets);
    ASSERT_EQ(planes.size(), facets.size());
    for (int i = 0; i < 50; ++i) {
      const Vec3 x = families::uniform(rng, 0.0, 2.0) * families::direction(rng);
      double least = 1e300;
      for (const Facet& f : facets) least = std::min(least, f.offset - f.n.dot(x));
      const Planes::Nearest nearest = planes.nearest(Vec<double>(x));
      ASSERT_LT(nearest.plane, planes.size());
      EXPECT_NEAR(nearest.depth, least, 1e-14) << "seed " << seed << ", " << count;
      const Vec3 n = to_vec3(planes.normal(nearest.plane));
      EXPECT_NEAR(planes.offset(nearest.plane) - n.dot(x), least, 1e-14);
    }
  }
}

TEST(Planes, OfABoxSayHowDeepAPointIs) {
  const Planes planes = Planes::box({1.0, 2.0, 3.0});
  EXPECT_EQ(planes.size(), 6U);
  EXPECT_DOUBLE_EQ(planes.nearest(Vec<double>(0.5, 0.0, 0.0)).depth, 0.5);
  EXPECT_DOUBLE_EQ(planes.nearest(Vec<double>(0.0, -1.9, 0.0)).depth, 2.0 - 1.9);
  EXPECT_DOUBLE_EQ(planes.nearest(Vec<double>(0.0, 0.0, 4.0)).depth, -1.0);
  EXPECT_DOUBLE_EQ(Planes::box({1.0, 0.0, 1.0}).nearest(Vec<double>()).depth, 0.0);
  EXPECT_TRUE(Planes().empty());
}

// A box finds its nearest plane without a scan; the result must be that of a scan.
TEST(Planes, OfABoxAreNamedAsInTheList) {
  families::Rng rng(seed);
  for (int i = 0; i < 1000; ++i) {
    SCOPED_TRACE(families::of_seed(seed, "point", i));
    const Planes planes = Planes::box(families::random_box(rng, 0.05, 0.6).half_extents);
    const Vec<double> x(Vec3(families::uniform(rng, 0.0, 1.0) * families::direction(rng)));
    std::uint32_t least = 0;
    const auto depth = [&](std::uint32_t p) { return planes.offset(p) - dot(planes.normal(p), x); };
    for (std::uint32_t p = 0; p < planes.size(); ++p) least = depth(p) < depth(least) ? p : least;
    EXPECT_EQ(planes.nearest(x).plane, least);
    EXPECT_EQ(planes.nearest(x).depth, depth(least));
    EXPECT_EQ(planes.nearest(Vec<DoubleDouble>(x)).plane, least);
  }
}

TEST(Planes, APointThatIsNotANumberHasSomePlane) {
  const Planes planes = Planes::box({1.0, 2.0, 3.0});
  const double none = std::numeric_limits<double>::quiet_NaN();
  EXPECT_LT(planes.nearest(Vec<double>(none, none, none)).plane, planes.size());
}

}  // namespace planes_test
}  // namespace repel
