// SPDX-License-Identifier: BSD-3-Clause
#include <repel/schedule/evaluators.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "pairs/boxes.hpp"

namespace repel {
namespace evaluators_test {

constexpr unsigned seed = 4545;

bool are_same(const Separation& a, const Separation& b) {
  const auto same = [](const Vec3& u, const Vec3& v) {
    return std::memcmp(u.data(), v.data(), 3 * sizeof(double)) == 0;
  };
  return a.distance == b.distance && a.lower == b.lower && a.upper == b.upper &&
         same(a.p_WA, b.p_WA) && same(a.p_WB, b.p_WB) && same(a.extraction_W, b.extraction_W) &&
         a.level == b.level && a.iterations == b.iterations && a.end == b.end;
}

TEST(Evaluators, DistancesHaveTheSameBitsWithEachInstructionSet) {
  families::Rng random(seed);
  std::vector<Shape> shapes{Shape::box({0.05, 0.05, 0.0})};
  for (int i = 0; i < 30; ++i) shapes.push_back(test::random_shape(random));
  for (const int corners : {32, 150}) {
    shapes.push_back(Shape::hull(families::cloud(random, corners, 0.08).vertices));
  }
  std::vector<Pose> poses;
  for (int i = 0; i < 400; ++i) poses.push_back(test::random_pose(random, 0.09));
  std::vector<PosedShapes> pairs;
  for (std::size_t i = 0; i < 2000; ++i) {
    pairs.push_back({{shapes[i % shapes.size()], poses[i % 399]},
                     {shapes[i / 7 % shapes.size()], poses[i * 13 % 400]}});
  }
  // A shape on itself, where all that decides is a zero and its sign: plates on themselves took two
  // steps more without AVX.
  for (const Pose& X_W : poses) {
    for (const std::size_t k : {0, 1, 31}) pairs.push_back({{shapes[k], X_W}, {shapes[k], X_W}});
  }
  int overlaps = 0;
  std::vector<std::vector<Separation>> cold, warm;
  for (const detail::Evaluators* one : detail::all_evaluators()) {
    std::vector<Separation> found(pairs.size());
    one->separations(pairs, {}, {}, found);
    cold.push_back(found);
    std::vector<WarmStart> left(pairs.size());
    one->separations(pairs, {}, left, found);
    one->separations(pairs, {}, left, found);
    warm.push_back(found);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      ASSERT_TRUE(are_same(cold[0][i], cold.back()[i])) << one->instruction_set << ", pair " << i;
      ASSERT_TRUE(are_same(warm[0][i], warm.back()[i])) << one->instruction_set << ", pair " << i;
      overlaps += cold[0][i].distance < 0.0 ? 1 : 0;
    }
  }
  EXPECT_GT(overlaps, 200) << "seed " << seed;
}

/// The forces at the ticks of a tool of boxes that moves among others.
std::vector<double> forces_by(const detail::Evaluators& evaluators) {
  test::Boxes boxes(6, 40, {.range = 0.15, .tilt = 0.01}, seed);
  const auto index = std::make_shared<const detail::PairIndex>(boxes.world);
  detail::PartPoses poses(boxes.world);
  const auto set = evaluators.make_pair_set(boxes.world, 6 * 40, {}, 0.0);
  set->track_all(*index);
  std::vector<double> all;
  for (int tick = 0; tick < 200; ++tick) {
    boxes.move();
    const Motion& motion = boxes.world.motion();
    poses.begin_tick();
    set->begin_tick(motion.tick);
    set->select(motion, poses, {});
    set->evaluate_all(motion, poses);
    set->finish(motion, poses);
    for (const Wrench& on : set->forces().on_body) {
      for (int k = 0; k < 3; ++k) all.insert(all.end(), {on.force[k], on.torque[k]});
    }
  }
  return all;
}

TEST(Evaluators, ForcesHaveTheSameBitsWithEachInstructionSet) {
  const std::vector<double> plain = forces_by(*detail::all_evaluators().front());
  EXPECT_GT(std::count_if(plain.begin(), plain.end(), [](double x) { return x != 0.0; }), 1000);
  for (const detail::Evaluators* one : detail::all_evaluators()) {
    const std::vector<double> these = forces_by(*one);
    ASSERT_EQ(these.size(), plain.size());
    EXPECT_EQ(std::memcmp(these.data(), plain.data(), plain.size() * sizeof(double)), 0)
        << one->instruction_set;
  }
}

}  // namespace evaluators_test
}  // namespace repel
