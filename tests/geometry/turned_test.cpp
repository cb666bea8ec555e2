// SPDX-License-Identifier: BSD-3-Clause
#include <repel/geometry/turned.hpp>

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include <support/families.hpp>

namespace repel::detail {
namespace turned_test {

using families::Rng;

constexpr unsigned seed = 612;

std::vector<Convex> sets(Rng& rng) {
  std::vector<Convex> all{Convex::box({0.3, 0.2, 0.5}), Convex::box({0.3, 0.0, 0.5}),
                          Convex::box({0, 0, 0}), Convex::cylinder(0.3, 0.5),
                          Convex::cone(0.4, -0.5, 0.5)};
  for (const int count : {1, 2, 7, 8, 9, 31, 32, 33, 200}) {
    all.push_back(Convex::polytope(families::cloud(rng, count, 0.5).vertices));
  }
  return all;
}

TEST(Turned, FindsTheFarthestPointThatTheSetFinds) {
  Rng rng(seed);
  int same_name = 0, total = 0;
  for (const Convex& set : sets(rng)) {
    for (int i = 0; i < 200; ++i) {
      SCOPED_TRACE(families::of_seed(seed, "direction", i));
      Pose X = Pose::Identity();
      X.linear() = families::rotation(rng);
      X.translation() = 5.0 * families::direction(rng);
      const Vec3 d = families::direction(rng);
      const Turned turned(set, X);
      const Turned::Point found = turned.support(Vec<double>(d));
      const auto own = set.support(rotate_transposed(X, Vec<double>(d)));
      EXPECT_NEAR(to_vec3(found.p).dot(d), (X.linear() * to_vec3(own.p)).dot(d), 1e-15);
      EXPECT_LE((to_vec3(turned.point(found.name).p) - to_vec3(found.p)).norm(), 1e-8);
      same_name += found.name == own.name ? 1 : 0;
      ++total;
    }
  }
  EXPECT_GT(same_name, total - total / 100);
}

TEST(Turned, ADirectionThatIsNotANumberGivesAPointOfTheSet) {
  Rng rng(seed);
  const Pose X = Pose::Identity();
  const Vec<double> none(std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0);
  for (const Convex& set : sets(rng)) {
    if (!set.is_polytope()) continue;
    EXPECT_LE(to_vec3(Turned(set, X).support(none).p).norm(), set.reach() * (1.0 + 1e-15));
  }
}

}  // namespace turned_test
}  // namespace repel::detail
