// SPDX-License-Identifier: BSD-3-Clause
#include <repel/contact/pointed_pair.hpp>

#include <gtest/gtest.h>

#include <repel/reduction/separation.hpp>
#include <repel/reduction/shape.hpp>
#include <support/families.hpp>

namespace repel::detail {
namespace pointed_pair_test {

constexpr unsigned seed = 4107;
constexpr double tilt = 0.005;

Shape draw(families::Rng& rng, int i) {
  const auto length = [&] { return families::uniform(rng, 0.02, 0.1); };
  switch (i % 5) {
    case 0:
      return Shape::box({length(), length(), length()});
    case 1:
      return Shape::hull(families::cloud(rng, families::count_between(rng, 4, 24), 0.1).vertices);
    case 2:
      return Shape::cylinder(length(), length());
    case 3:
      return Shape::cylinder(0.0, length());
    default:
      return Shape::hull(
          families::prism(families::count_between(rng, 3, 9), length(), length()).vertices);
  }
}

// Two shapes turn slowly against each other, near or in overlap: what is remembered of where they
// have no patch changes no patch.
TEST(PointedPair, RememberingChangesNoPatch) {
  families::Rng rng(seed);
  int ruled_out = 0, searched = 0, found = 0;
  for (int i = 0; i < 400; ++i) {
    SCOPED_TRACE(families::of_seed(seed, "pair", i));
    const Shape a = draw(rng, i);
    const Shape b = draw(rng, i / 5);
    Pose X_WA = Pose::Identity();
    Pose X_WB = Pose::Identity();
    X_WA.linear() = families::rotation(rng);
    X_WB.linear() = i % 2 == 0 ? X_WA.linear() : families::rotation(rng);
    X_WA.translation() = families::uniform(rng, 0.0, 0.2) * families::direction(rng);
    PointedPair pair;
    WarmStart warm;
    const Vec3 axis = families::direction(rng);
    for (int k = 0; k < 60; ++k) {
      X_WA.linear() = Eigen::AngleAxisd(0.004, axis).toRotationMatrix() * X_WA.linear();
      X_WA.translation() += 1e-3 * families::direction(rng);
      const Separation s = separation(a, X_WA, b, X_WB, {}, warm);
      if (norm(s.extraction_W) < 0.5) continue;
      ContactPatch wanted, remembered;
      const bool is_there = find_patch(s, {a, X_WA}, {b, X_WB}, tilt, wanted);
      ruled_out += pair.rule_out(Vec<double>(s.extraction_W), X_WA, X_WB) ? 1 : 0;
      ++searched;
      ASSERT_EQ(pair.find_patch(s, {a, X_WA}, {b, X_WB}, tilt, remembered), is_there);
      found += is_there ? 1 : 0;
      EXPECT_EQ(remembered.nearer, wanted.nearer);
      EXPECT_EQ(remembered.gradient.force, wanted.gradient.force);
      EXPECT_EQ(remembered.gradient.torque, wanted.gradient.torque);
    }
  }
  EXPECT_GT(searched, 20000);
  EXPECT_GT(ruled_out, 5000);
  EXPECT_GT(found, 3000);
}

}  // namespace pointed_pair_test
}  // namespace repel::detail
