// SPDX-License-Identifier: BSD-3-Clause
#include <repel/pairs/pair_search.hpp>

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "pairs/boxes.hpp"

namespace repel::detail {
namespace pair_search_test {

constexpr unsigned seed = 905;

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
  void drop(std::int32_t list) noexcept { lists.erase(list); }
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

/// Checks a search against all pairs, and counts what the sample had.
struct Counts {
  std::int64_t in_range = 0, listed = 0, pairs = 0;

  void add(const World& world, const Lists& lists) {
    for (std::int32_t i = 0; i < static_cast<std::int32_t>(world.pairs().size()); ++i) {
      const Pair& pair = world.pair({i});
      const bool near = test::separation_now(world, pair).distance <= pair.law.range;
      ASSERT_TRUE(!near || lists.holds(i)) << "pair " << i;
      in_range += near ? 1 : 0;
      listed += lists.holds(i) ? 1 : 0;
      ++pairs;
    }
  }
};

TEST(PairSearch, EveryPairThatIsInRangeIsOnAList) {
  Counts counts;
  for (unsigned run = 0; run < 4; ++run) {
    test::Crowd crowd(seed + run);
    PairSearch search(std::make_shared<PairIndex>(crowd.world));
    Lists lists(crowd.world);
    for (int tick = 0; tick < 200; ++tick) {
      crowd.move();
      search.run(crowd.world.motion(), lists);
      SCOPED_TRACE(families::of_seed(seed + run, "tick", tick));
      ASSERT_NO_FATAL_FAILURE(counts.add(crowd.world, lists));
    }
  }
  // The sample is meaningful: some pairs were near, and most were left out.
  EXPECT_GT(counts.in_range, 1000);
  EXPECT_LT(counts.listed, counts.pairs / 2);
}

/// Moves three bodies in one of several ways: a random walk, to and fro, turning on the spot,
/// together, or by jumps out of reach and back.
class Motions {
 public:
  Motions(World& world, unsigned of) : world_(&world), random_(of) {
    for (std::int32_t i = 1; i < world.body_count(); ++i) homes_.push_back(X_WB(i));
  }
  void move() {
    if (families::count_between(random_, 0, 39) == 0) begin();
    const Pose together = moved(Pose::Identity(), 0.01, 0.02);
    for (std::int32_t i = 1; i < world_->body_count(); ++i) {
      Pose X = X_WB(i);
      const Pose& home = homes_[i - 1];
      if (way_ == 0) X = moved(X, 0.01, 0.05);
      if (way_ == 1) X = moved(home, size_, size_);
      if (way_ == 2) X.linear() = moved(X, 0.0, 0.3).linear();
      if (way_ == 3) X = together * X;
      if (way_ == 4) X.translation().z() += away_ ? -3.0 : 3.0;
      X.linear() = Eigen::Quaterniond(X.linear()).normalized().toRotationMatrix();
      if (way_ != 4) X.translation() *= std::min(1.0, 0.5 / std::max(1e-9, X.translation().norm()));
      EXPECT_TRUE(world_->place({i}, X, {}));
      if (way_ == 4) break;  // only the first of them
    }
    away_ = way_ == 4 && !away_;
  }

 private:
  void begin() {
    if (away_) return;
    way_ = families::count_between(random_, 0, 4);
    size_ = families::log_uniform(random_, 1e-4, 0.1);
    for (std::int32_t i = 1; i < world_->body_count(); ++i) homes_[i - 1] = X_WB(i);
  }
  [[nodiscard]] Pose X_WB(std::int32_t i) const { return world_->motion().bodies[i].X_WB; }
  [[nodiscard]] Pose moved(Pose X, double by, double angle) {
    X.linear() =
        families::small_rotation(random_, families::uniform(random_, 0.0, angle)) * X.linear();
    X.translation() += families::uniform(random_, 0.0, by) * families::direction(random_);
    return X;
  }

  World* world_;
  families::Rng random_;
  std::vector<Pose> homes_;
  int way_ = 0;
  double size_ = 0.0;  ///< [m, rad]
  bool away_ = false;
};

TEST(PairSearch, EveryPairThatIsInRangeIsOnAListHoweverBodiesMove) {
  Counts counts;
  for (unsigned run = 0; run < 6; ++run) {
    test::Crowd crowd(seed + run);
    Motions motions(crowd.world, seed + run);
    PairSearch search(std::make_shared<PairIndex>(crowd.world));
    Lists lists(crowd.world);
    for (int tick = 0; tick < 400; ++tick) {
      motions.move();
      search.run(crowd.world.motion(), lists);
      SCOPED_TRACE(families::of_seed(seed + run, "tick", tick));
      ASSERT_NO_FATAL_FAILURE(counts.add(crowd.world, lists));
    }
  }
  EXPECT_GT(counts.in_range, 1000);
  EXPECT_LT(counts.listed, counts.pairs / 2);
}

TEST(PairSearch, DoesNotSearchAgainWhileBodiesMoveToAndFroOrTogether) {
  families::Rng random(seed);
  World world;
  std::vector<PartId> parts;
  for (const char* name : {"tool", "table"}) {
    const BodyId body = world.add_body(name);
    for (int i = 0; i < 20; ++i) {
      parts.push_back(
          world.add_part(body, "part", test::random_box(random), test::random_pose(random, 0.3)));
    }
  }
  for (int i = 0; i < 20; ++i) {
    for (int j = 20; j < 40; ++j) world.add_pair(parts[i], parts[j], {});
  }
  PairSearch search(std::make_shared<PairIndex>(world));
  Lists lists(world);
  int first = 0;
  for (int tick = 0; tick < 2000; ++tick) {
    // The first margins are shorter.
    if (tick == 500) first = lists.asked;
    const bool together = tick % 2 == 0;
    const Pose X = together ? test::random_pose(random, 0.5) : Pose::Identity();
    for (const BodyId body : {BodyId{1}, BodyId{2}}) {
      Pose X_WB = X;
      if (!together) {
        X_WB.linear() = families::small_rotation(random, 0.005);
        X_WB.translation() = 0.002 * families::direction(random);
      }
      ASSERT_TRUE(world.place(body, X_WB, {}));
    }
    search.run(world.motion(), lists);
  }
  EXPECT_GT(first, 10) << "seed " << seed;
  EXPECT_EQ(lists.asked, first) << "seed " << seed;
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

// Of two pairs found, one remains a candidate when their part jumps away, the other does not.
TEST(PairSearch, PairsOfAListOfWhichSomeWereKeptAreFoundWhenItsPartReturns) {
  World world;
  const BodyId tool = world.add_body("tool");
  const auto at = [](double x) {
    Pose X = Pose::Identity();
    X.translation().x() = x;
    return X;
  };
  const PartId part = world.add_part(tool, "part", Shape::sphere(0.1));
  const PartId far = world.add_part(tool, "far part", Shape::sphere(0.1), at(3.0));
  for (const double x : {0.0, 0.05}) {
    const PartId wall = world.add_part(World::fixed, "wall", Shape::sphere(0.1), at(x));
    for (const PartId id : {part, far}) world.add_pair(id, wall, {});
  }
  PairSearch search(std::make_shared<PairIndex>(world));
  Lists lists(world);
  const auto found_at = [&](double x) {
    EXPECT_TRUE(world.place(tool, at(x), {}));
    lists.taken = 0;
    search.run(world.motion(), lists);
    return lists.taken;
  };
  for (const int keeps : {1, 0, 1, 1}) {
    EXPECT_EQ(found_at(0.1), 2) << keeps;
    lists.keeps = keeps;
    EXPECT_EQ(found_at(-30.0), 0);
    lists.keeps = 0;
  }
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

}  // namespace pair_search_test
}  // namespace repel::detail
