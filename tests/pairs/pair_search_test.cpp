#include <repel/pairs/pair_search.hpp>

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "pairs/boxes.hpp"

namespace repel::detail {
namespace pair_search_test {

constexpr unsigned seed = 905;

TEST(BoxOf, HoldsThePartAndTouchesIt) {
  families::Rng random(seed);
  World world;
  const BodyId body = world.add_body("body");
  const std::vector<Vec3> corners{{0, 0, 0}, {0.3, 0, 0}, {0, 0.2, 0}, {0, 0, 0.1}};
  for (const Shape& shape :
       {Shape::box({0.1, 0.2, 0.3}), Shape::sphere(0.1), Shape::capsule(0.1, 0.2),
        Shape::cylinder(0.1, 0.3), Shape::cone(0.2, 0.1), Shape::hull(corners)}) {
    const PartId id = world.add_part(body, "part", shape, test::random_pose(random, 0.5));
    const Part& part = world.part(id);
    const Box box = box_of(part);
    // A plane far away along an axis is equally far from the box and from the part.
    for (int axis = 0; axis < 3; ++axis) {
      for (const double side : {-1.0, 1.0}) {
        Pose X = Pose::Identity();
        X.translation() = box.center();
        X.translation()[axis] = side * 1e4;
        Vec3 half(1e5, 1e5, 1e5);
        half[axis] = 0.0;
        const double gap = separation(shape, part.X_BP, Shape::box(half), X).distance;
        const double reach = side > 0 ? box.max()[axis] : -box.min()[axis];
        EXPECT_NEAR(1e4 - gap, reach, 1e-6);
      }
    }
  }
}

/// Keeps the lists as a block does.
struct Lists {
  bool take(PairId id, std::int32_t list, double distance) noexcept {
    const Pair& pair = world->pair(id);
    const double truth = test::separation_now(*world, pair).distance;
    EXPECT_LE(distance, std::max(0.0, truth) + 1e-12) << "pair " << id.index;
    ++taken;
    coming[list].insert(id.index);
    return accepts;
  }
  int end(std::int32_t list) noexcept {
    lists[list] = coming[list];
    coming[list].clear();
    ++asked;
    return keeps;
  }
  [[nodiscard]] bool holds(std::int32_t pair) const {
    return std::any_of(lists.begin(), lists.end(),
                       [&](const auto& list) { return list.second.contains(pair); });
  }
  explicit Lists(const World& a_world) : world(&a_world) {}
  const World* world;
  std::map<std::int32_t, std::set<std::int32_t>> coming, lists;
  bool accepts = true;
  int keeps = 0;
  int taken = 0;
  int asked = 0;
};

TEST(PairSearch, EveryPairThatIsInRangeIsOnAList) {
  std::int64_t listed = 0, in_range = 0, pairs = 0;
  for (unsigned run = 0; run < 4; ++run) {
    test::Crowd crowd(seed + run);
    PairSearch search(std::make_shared<PairIndex>(crowd.world));
    Lists lists(crowd.world);
    for (int tick = 0; tick < 200; ++tick) {
      crowd.move();
      search.run(crowd.world.motion(), lists);
      for (std::int32_t i = 0; i < static_cast<std::int32_t>(crowd.world.pairs().size()); ++i) {
        const Pair& pair = crowd.world.pair({i});
        const bool near = test::separation_now(crowd.world, pair).distance <= pair.law.range;
        ASSERT_TRUE(!near || lists.holds(i))
            << "pair " << i << ", tick " << tick << ", seed " << seed + run;
        in_range += near ? 1 : 0;
        listed += lists.holds(i) ? 1 : 0;
        ++pairs;
      }
    }
  }
  // The sample is meaningful: some pairs were near, and most were left out.
  EXPECT_GT(in_range, 1000);
  EXPECT_LT(listed, pairs / 2);
}

TEST(PairSearch, DoesNotSearchAgainWithinItsMargin) {
  test::Boxes boxes(4, 100, {}, seed);
  PairSearch search(std::make_shared<PairIndex>(boxes.world));
  Lists lists(boxes.world);
  const auto taken = [&] {
    lists.taken = 0;
    search.run(boxes.world.motion(), lists);
    return lists.taken;
  };
  const int first = taken();
  EXPECT_GT(first, 20) << "seed " << seed;
  EXPECT_EQ(taken(), 0);
  // The lists are searched again at different times, each after its margin.
  int later = 0, most = 0;
  constexpr int steps = 300;
  for (int step = 1; step <= steps; ++step) {
    Pose X = Pose::Identity();
    X.translation().x() = 0.001 * step;
    boxes.world.place(boxes.tool, X, {});
    const int now = taken();
    later += now;
    most = std::max(most, now);
  }
  EXPECT_GT(later, first) << "seed " << seed;
  EXPECT_LT(later, first * (2 + 0.001 * steps / PairSearch::margin)) << "seed " << seed;
  EXPECT_LT(most, first) << "seed " << seed;
}

// Parts that cannot come near the other body cost nothing until it has moved far.
TEST(PairSearch, ListsFarFromTheOtherBodyAreNotActive) {
  World world;
  const BodyId tool = world.add_body("tool");
  const PartId part = world.add_part(tool, "part", Shape::box({0.1, 0.1, 0.1}));
  for (int i = 0; i < 50; ++i) {
    Pose X = Pose::Identity();
    X.translation().x() = 0.5 * i;
    world.add_pair(part, world.add_part(World::fixed, "wall", Shape::sphere(0.1), X), {});
  }
  PairSearch search(std::make_shared<PairIndex>(world));
  Lists lists(world);
  std::set<std::int32_t> touched;
  for (int step = 0; step <= 2450; ++step) {
    Pose X = Pose::Identity();
    X.translation().x() = 0.01 * step;
    ASSERT_TRUE(world.place(tool, X, {}));
    lists.asked = 0;
    search.run(world.motion(), lists);
    ASSERT_LE(lists.asked, 3) << "step " << step;
    for (std::int32_t i = 0; i < 50; ++i) {
      const bool near = std::abs(0.5 * i - 0.01 * step) < 0.2;
      if (near) touched.insert(i);
      ASSERT_TRUE(!near || lists.holds(i)) << "pair " << i << ", step " << step;
    }
  }
  EXPECT_EQ(touched.size(), 50U);
}

// A pair in a lane remains a candidate when its part jumps away. If its list were not searched any
// more, it would remain one for ever.
TEST(PairSearch, ListIsActiveWhilePairsOfItAreKept) {
  World world;
  const BodyId tool = world.add_body("tool");
  const PartId part = world.add_part(tool, "part", Shape::sphere(0.1));
  for (const double x : {0.0, -1.0, 60.0}) {
    Pose X = Pose::Identity();
    X.translation().x() = x;
    world.add_pair(part, world.add_part(World::fixed, "wall", Shape::sphere(0.1), X), {});
  }
  PairSearch search(std::make_shared<PairIndex>(world));
  Lists lists(world);
  const auto ended_at = [&](double x) {
    Pose X = Pose::Identity();
    X.translation().x() = x;
    EXPECT_TRUE(world.place(tool, X, {}));
    lists.asked = 0;
    search.run(world.motion(), lists);
    return lists.asked;
  };
  EXPECT_EQ(ended_at(0.15), 1);
  lists.keeps = 1;
  int ended = 0;
  for (int x = 1; x < 25; ++x) ended += ended_at(x);
  EXPECT_GE(ended, 2);
  lists.keeps = 0;
  ended = 0;
  for (int x = 25; x < 50; ++x) ended += ended_at(x);
  EXPECT_EQ(ended, 1);
}

TEST(PairSearch, PairThatWasNotTakenIsOfferedAgain) {
  test::Boxes boxes(1, 4, {.range = 2.0}, seed);
  PairSearch search(std::make_shared<PairIndex>(boxes.world));
  Lists lists(boxes.world);
  lists.accepts = false;
  for (int i = 1; i < 4; ++i) {
    search.run(boxes.world.motion(), lists);
    EXPECT_EQ(lists.taken, 4 * i);
  }
  lists.accepts = true;
  search.run(boxes.world.motion(), lists);
  search.run(boxes.world.motion(), lists);
  EXPECT_EQ(lists.taken, 16);
}

TEST(PairIndex, ListsWithTheSamePartnersShareATree) {
  const test::Boxes boxes(4, 100, {}, seed);
  const PairIndex index(boxes.world);
  EXPECT_EQ(index.body_pairs.size(), 1U);
  EXPECT_EQ(index.lists.size(), 100U);
  EXPECT_EQ(index.trees.size(), 1U);
  EXPECT_EQ(index.pairs.size(), 400U);
}

TEST(PairIndex, TheBodyWhosePartsAreSpreadWiderHasTheListsWhicheverIsNamedFirst) {
  for (const bool wall_first : {false, true}) {
    World world;
    const BodyId tool = world.add_body("tool");
    const PartId part = world.add_part(tool, "part", Shape::sphere(0.1));
    for (int i = 0; i < 5; ++i) {
      Pose X = Pose::Identity();
      X.translation().y() = 0.3 * i;
      const PartId wall = world.add_part(World::fixed, "wall", Shape::sphere(0.1), X);
      world.add_pair(wall_first ? wall : part, wall_first ? part : wall, {});
    }
    const PairIndex index(world);
    ASSERT_EQ(index.body_pairs.size(), 1U);
    EXPECT_EQ(index.body_pairs[0].a, World::fixed);
    EXPECT_EQ(index.lists.size(), 5U);
  }
}

}  // namespace pair_search_test
}  // namespace repel::detail
