// SPDX-License-Identifier: BSD-3-Clause
#include <repel/geometry/box_tree.hpp>

#include <gtest/gtest.h>

#include <set>

#include <support/families.hpp>

namespace repel {
namespace box_tree_test {

constexpr unsigned seed = 2611;

Box random_box(families::Rng& random, double within, double size) {
  Vec3 centre, half;
  for (int axis = 0; axis < 3; ++axis) {
    centre[axis] = families::uniform(random, -within, within);
    half[axis] = families::uniform(random, 0.0, size);
  }
  return {centre - half, centre + half};
}

double distance_of(const Box& a, const Box& b) {
  return Eigen::AlignedBox3d(a.min(), a.max())
      .exteriorDistance(Eigen::AlignedBox3d(b.min(), b.max()));
}

void expect_what_a_scan_finds(const std::vector<Box>& boxes, const Box& probe, double within) {
  std::set<int> found;
  const double others = BoxTree(boxes).query(probe, within, [&](int i, double distance) {
    EXPECT_TRUE(found.insert(i).second) << "box " << i << " twice";
    const double truth = distance_of(boxes[i], probe);
    EXPECT_LE(distance, truth);
    // Single-precision coordinates, and the rounding of the distance.
    EXPECT_GE(distance, truth * (1.0 - 2e-6) - 1e-6 * (1.0 + centre(boxes[i]).norm()));
  });
  for (int i = 0; i < static_cast<int>(boxes.size()); ++i) {
    const double truth = distance_of(boxes[i], probe);
    if (truth <= within) {
      EXPECT_TRUE(found.contains(i)) << "box " << i << " at " << truth;
    }
    if (!found.contains(i)) {
      EXPECT_LE(others, truth) << "box " << i;
    }
  }
  EXPECT_GT(others, within);
}

TEST(BoxTree, ABoxIsExtendedAroundPointsAndBoxes) {
  const Vec3 low(1, -2, 3), high(2, 0, 3);
  Box box;
  EXPECT_FALSE(box.contains(low));
  EXPECT_EQ(box.extend(low).min(), low);
  EXPECT_EQ(box.max(), low);
  EXPECT_FALSE(box.contains(high));
  EXPECT_EQ(box.extend(Box(high)).max(), high);
  EXPECT_EQ(box.min(), low);
  EXPECT_TRUE(box.contains(low) && box.contains(high) && box.contains(centre(box)));
  EXPECT_FALSE(box.contains(high + unit(2)));
}

TEST(BoxTree, FindsWhatAScanFinds) {
  families::Rng random(seed);
  for (const int count : {0, 1, 2, 3, 4, 5, 7, 16, 17, 65, 300, 1000}) {
    std::vector<Box> boxes;
    for (int i = 0; i < count; ++i) boxes.push_back(random_box(random, 1.0, 0.1));
    for (int i = 0; i < 30; ++i) {
      SCOPED_TRACE(families::of_seed(seed, "query", i) + ", boxes " + std::to_string(count));
      expect_what_a_scan_finds(boxes, random_box(random, 1.2, 0.2),
                               families::uniform(random, 0.0, 0.4));
    }
  }
}

TEST(BoxTree, BoxesAtOnePlaceAreAllFound) {
  const Box box(Vec3(1, 2, 3), Vec3(1, 2, 3));
  const std::vector<Box> boxes(1000, box);
  expect_what_a_scan_finds(boxes, box, 0.0);
  expect_what_a_scan_finds(boxes, {Vec3(1, 2, 4), Vec3(1, 2, 4)}, 0.5);
}

TEST(BoxTree, PlacesBeyondSinglePrecisionErrInward) {
  std::vector<Box> boxes;
  for (const double x : {-1e300, -1e15, -16777217.0, 0.1, 16777217.0, 1e15, 1e300}) {
    boxes.emplace_back(Vec3(x, 0, 0), Vec3(x, 0, 0));
  }
  for (const Box& probe : boxes) {
    bool itself = false;
    const double others = BoxTree(boxes).query(probe, 0.0, [&](int i, double distance) {
      itself = itself || (boxes[i].min() == probe.min() && distance == 0.0);
    });
    EXPECT_TRUE(itself) << probe.min().x();
    EXPECT_LE(others, 1e18);
  }
}

TEST(BoxTree, OthersAreAsFarAsTheNearestOfThem) {
  std::vector<Box> boxes;
  for (int i = 0; i < 100; ++i) boxes.emplace_back(Vec3(i, 0, 0), Vec3(i + 0.5, 1, 1));
  const Box probe(Vec3(-1, 0, 0), Vec3(-0.5, 1, 1));
  int found = 0;
  const double others = BoxTree(boxes).query(probe, 2.0, [&](int, double) { ++found; });
  EXPECT_EQ(found, 2);
  EXPECT_NEAR(others, 2.5, 1e-5);
}

}  // namespace box_tree_test
}  // namespace repel
