// SPDX-License-Identifier: BSD-3-Clause
#include <repel/contact/tilt_mean.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include <support/families.hpp>

namespace repel {
namespace tilt_mean_test {

using namespace detail;

constexpr double tilt = 0.01;

TiltMean mean_of(const Outline& outline, const Planar& slope, double of_tilt) {
  Sides sides;
  sides.find(outline);
  return {outline, sides, slope, of_tilt, 0.0};
}

/// The same mean by brute force: a grid over the disc.
struct Brute {
  double nearer = 0.0;
  Planar point{};
};

Brute brute(const Outline& outline, const Planar& s) {
  constexpr int grid = 400;
  Brute sum;
  int count = 0;
  for (int k = 0; k < grid * grid; ++k) {
    const Planar theta{tilt * (2.0 * (k % grid + 0.5) / grid - 1.0),
                       tilt * (2.0 * (k / grid + 0.5) / grid - 1.0)};
    if (dot(theta, theta) > tilt * tilt) continue;
    ++count;
    const Planar y = s + theta;
    int best = 0;
    for (int i = 1; i < outline.size; ++i) {
      if (dot(y, outline.at(i).r) > dot(y, outline.at(best).r)) best = i;
    }
    sum.nearer += dot(y, outline.at(best).r);
    sum.point = sum.point + outline.at(best).r;
  }
  return {sum.nearer / count, (1.0 / count) * sum.point};
}

Outline polygon(families::Rng& rng, int corners) {
  std::vector<double> angles;
  for (int i = 0; i < corners; ++i) angles.push_back(families::uniform(rng, 0.0, 2.0 * M_PI));
  std::sort(angles.begin(), angles.end());
  Outline outline;
  const Planar shift{families::uniform(rng, -0.05, 0.05), families::uniform(rng, -0.05, 0.05)};
  for (const double a : angles) outline.add(shift + 0.1 * Planar{std::cos(a), std::sin(a)}, true);
  return outline;
}

TEST(TiltMean, IsTheMeanOverTheDisc) {
  constexpr unsigned seed = 21;
  families::Rng rng(seed);
  int parted = 0;
  for (int i = 0; i < 60; ++i) {
    SCOPED_TRACE(families::of_seed(seed, "outline", i));
    const Outline outline = polygon(rng, families::count_between(rng, 2, 7));
    const Planar s{families::uniform(rng, -1.5, 1.5) * tilt,
                   families::uniform(rng, -1.5, 1.5) * tilt};
    const TiltMean mean = mean_of(outline, s, tilt);
    const Brute truth = brute(outline, s);
    // Of a polygon, what it is without slope is taken off, with a weight that falls with the slope.
    const double x = norm(s) / (TiltMean::faded * tilt);
    const double weight = outline.size > 2 ? (1.0 - x * x) * (1.0 - x * x) : 0.0;
    const double flat = weight > 0.0 ? brute(outline, {0.0, 0.0}).nearer : 0.0;
    EXPECT_NEAR(mean.nearer(), truth.nearer - weight * flat, 2e-6);
    const double fall = 4.0 * x * (1.0 - x * x) / (TiltMean::faded * tilt) * flat;
    EXPECT_LE(norm(mean.point() - truth.point - fall / norm(s) * s), 6e-4);
    parted += mean.held() == 0.0 ? 1 : 0;
  }
  EXPECT_GT(parted, 40);
}

TEST(TiltMean, IsTheCornerItselfWhereEveryTiltFindsIt) {
  Outline outline;
  for (const Planar& r : {Planar{0.0, 0.0}, Planar{-0.1, 0.0}, Planar{-0.1, -0.1}}) {
    outline.add(r, true);
  }
  const TiltMean mean = mean_of(outline, {0.08, 0.08}, tilt);
  EXPECT_EQ(mean.nearer(), 0.0);
  EXPECT_EQ(norm(mean.point()), 0.0);
  EXPECT_EQ(mean.held(), 1.0);
}

// The gradient with respect to the slope is the mean point, whether the tip of the cones is inside
// the disc or not.
TEST(TiltMean, ThePointIsTheGradient) {
  constexpr unsigned seed = 22;
  families::Rng rng(seed);
  constexpr double h = 1e-8;
  for (int i = 0; i < 500; ++i) {
    SCOPED_TRACE(families::of_seed(seed, "outline", i));
    const Outline outline = polygon(rng, families::count_between(rng, 2, 8));
    const Planar s{families::uniform(rng, -2.0, 2.0) * tilt,
                   families::uniform(rng, -2.0, 2.0) * tilt};
    const auto at = [&](double x, double y) {
      return mean_of(outline, s + Planar{x, y}, tilt).nearer();
    };
    const Planar found = mean_of(outline, s, tilt).point();
    EXPECT_NEAR((at(h, 0.0) - at(-h, 0.0)) / (2.0 * h), found.x, 1e-6);
    EXPECT_NEAR((at(0.0, h) - at(0.0, -h)) / (2.0 * h), found.y, 1e-6);
  }
}

// A polygon that degenerates to a segment, and a bend that vanishes, change nothing.
TEST(TiltMean, ThinPolygonsAndSmallBendsAreSegments) {
  Outline segment;
  segment.add({-0.1, 0.0}, true);
  segment.add({0.06, 0.0}, true);
  Outline sliver;
  sliver.add({-0.1, 0.0}, true);
  sliver.add({0.06, 0.0}, true);
  sliver.add({0.06, 1e-6}, true);
  sliver.add({-0.1, 1e-6}, true);
  Outline bent = segment;
  bent.bend = 1e-6;
  for (const double s : {-0.02, -0.007, 0.0, 0.003, 0.009, 0.02}) {
    const TiltMean of_segment = mean_of(segment, {s, 0.0}, tilt);
    // A thin polygon has the middle taken off, beyond which its point lies by a seventh at most.
    EXPECT_NEAR(of_segment.point().x, mean_of(sliver, {s, 0.0}, tilt).point().x, 0.16 / 7.0);
    EXPECT_NEAR(of_segment.point().x, mean_of(bent, {s, 0.0}, tilt).point().x, 1e-5);
    EXPECT_NEAR(of_segment.nearer(), mean_of(bent, {s, 0.0}, tilt).nearer(), 1e-8);
  }
}

TEST(TiltMean, ABendDrawsTheNearestPointToTheCrossing) {
  Outline crossing;
  crossing.add({-0.1, 0.0}, true);
  crossing.add({0.1, 0.0}, true);
  crossing.bend = 2.0;
  // Along it the gap is x^2 - s x: lowest at s / 2.
  const TiltMean mean = mean_of(crossing, {0.04, 0.0}, tilt);
  EXPECT_NEAR(mean.point().x, 0.02, 1e-12);
  EXPECT_NEAR(mean.square(), 0.02 * 0.02 + tilt * tilt / 4.0 / 4.0, 1e-9);
  EXPECT_NEAR(mean.nearer(), 0.04 * 0.02 - 0.02 * 0.02 + tilt * tilt / 16.0, 1e-9);
}

}  // namespace tilt_mean_test
}  // namespace repel
