// SPDX-License-Identifier: BSD-3-Clause
#include <repel/schedule/world_changes.hpp>

#include <gtest/gtest.h>

#include <repel/reduction/separation.hpp>

#include <atomic>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <thread>
#include <vector>

#include <repel/reduction/shape.hpp>
#include "support/draws.hpp"

namespace repel {
namespace world_changes_test {

using families::draws;

constexpr double dt = 1.0 / 400.0;  // [s]
const ForceLaw law{.range = 0.02, .surface_force = 20.0, .damping = 30.0, .ceiling = 40.0};

Pose random_pose(std::mt19937& random, double spread) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> place(-spread, spread);
  Eigen::Quaterniond q(normal(random), normal(random), normal(random), normal(random));
  Pose X = Pose::Identity();
  X.linear() = q.normalized().toRotationMatrix();
  X.translation() = Vec3(place(random), place(random), place(random));
  return X;
}

Shape random_shape(std::mt19937& random, double room) {
  std::uniform_real_distribution<double> size(0.2 * room, 0.55 * room);
  switch (random() % 4) {
    case 0:
      return Shape::box({size(random), size(random), size(random)}, {.levels = 1});
    case 1:
      return Shape::sphere(size(random), {.levels = 1});
    case 2:
      return Shape::cylinder(size(random), size(random), {.levels = 1});
    default:
      break;
  }
  std::vector<Vec3> points;
  for (int i = 0; i < 20; ++i) {
    Vec3 p(size(random), size(random), size(random));
    for (int axis = 0; axis < 3; ++axis) p[axis] *= random() % 2 == 0 ? 1.0 : -1.0;
    points.push_back(p);
  }
  return Shape::hull(points, {.levels = 1});
}

/// Two tools, one with a link, among obstacles and parts that come and go.
struct Scene {
  static constexpr double spread = 0.25;  // [m]
  static constexpr double room = 0.1;     // [m]

  explicit Scene(unsigned seed) : random(seed) {
    std::vector<PartId> lasting;
    for (int i = 0; i < 6; ++i) {
      lasting.push_back(world.add_part(World::fixed, "wall", random_shape(random, room),
                                       random_pose(random, spread)));
    }
    for (int i = 0; i < 2; ++i) {
      tools.push_back(world.add_body("tool"));
      world.join(tools.back(), tools.back());
      world.spare_held(tools.back());
    }
    link = world.add_body("link");
    world.join(link, tools[0]);
    for (const BodyId body : {tools[0], tools[1], link}) {
      arm_parts.push_back(world.add_part(body, "arm", random_shape(random, room)));
    }
    for (const PartId arm : arm_parts) {
      for (const PartId wall : lasting) (void)world.add_pair(arm, wall, law);
    }
    for (int i = 0; i < 8; ++i) {
      const PartId id = world.reserve("loose", Shape::sphere(0.01), room);
      for (const PartId arm : arm_parts) (void)world.add_pair(arm, id, law);
      for (const PartId wall : lasting) (void)world.add_pair(id, wall, law);
      for (const PartId other : loose) (void)world.add_pair(id, other, law);
      loose.push_back(id);
    }
    for (int i = 0; i < 3; ++i) from.push_back(random_pose(random, spread));
    to = from;
  }

  /// Places the arms for tick k: each glides from one random pose to the next.
  void move_arms(int k) {
    constexpr int whole = 100;  // ticks
    const double share = static_cast<double>(k % whole) / whole;
    int i = 0;
    for (const BodyId body : {tools[0], tools[1], link}) {
      if (k % whole == 0) {
        from[i] = to[i];
        to[i] = random_pose(random, spread);
      }
      detail::PoseMove way{from[i], to[i], whole * dt, share * whole * dt};
      EXPECT_TRUE(world.place(body, way.pose(), way.twist()));
      ++i;
    }
  }

  std::mt19937 random;
  World world;
  std::vector<BodyId> tools;
  BodyId link;
  std::vector<PartId> arm_parts, loose;
  std::vector<Pose> from, to;
};

/// Asks for random changes; some make no sense.
void ask(Scene& scene, WorldChanges& changes, std::vector<PartId>& used, double over) {
  std::mt19937& random = scene.random;
  const auto any = [&] { return used.empty() ? PartId{} : used[random() % used.size()]; };
  switch (random() % 6) {
    case 0: {
      const PartId id =
          changes.add(random_shape(random, Scene::room), random_pose(random, Scene::spread), over);
      if (id.valid()) used.push_back(id);
      break;
    }
    case 1:
      (void)changes.move(any(), random_pose(random, Scene::spread), 0.5);
      break;
    case 2:
      (void)changes.attach(any(), scene.tools[random() % 2], over);
      break;
    case 3:
      (void)changes.release(any(), over);
      break;
    case 4:
      if (used.size() > 4) {
        const std::size_t i = random() % used.size();
        (void)changes.remove(used[i], over);
        used.erase(used.begin() + static_cast<std::ptrdiff_t>(i));
      }
      break;
    default:
      break;
  }
}

/// What a run leaves of every tick, for comparisons.
struct Trace {
  std::vector<Wrench> on_tool;
  ChangeCounts counts;
  int near = 0;
};

/// The forces of one tick, pair by pair, from nothing but the shapes and poses.
std::vector<double> largest_by_pair(const World& world) {
  std::vector<double> sizes;
  for (std::size_t i = 0; i < world.pairs().size(); ++i) {
    const Pair& pair = world.pairs()[i];
    const auto state = [&](PartId id) -> const BodyState& {
      return world.motion().bodies[static_cast<std::size_t>(world.part(id).body.index)];
    };
    const auto pose = [&](PartId id) { return composed(state(id).X_WB, world.part(id).X_BP); };
    const double share = share_between(state(pair.a), state(pair.b)).now;
    double size = 0.0;
    if (share > 0.0) {
      const Separation s = separation(world.part(pair.a).shape, pose(pair.a),
                                      world.part(pair.b).shape, pose(pair.b));
      size = share * pair.law.spring(s.distance);
    }
    sizes.push_back(size);
  }
  return sizes;
}

Trace run(unsigned seed, int ticks, const CoprocessorOptions& options, double over, bool compare) {
  Scene scene(seed);
  Coprocessor coprocessor(scene.world, options);
  WorldChanges changes(scene.world);
  std::vector<PartId> used;
  Trace trace;
  int compared = 0;
  for (int k = 0; k < ticks; ++k) {
    ask(scene, changes, used, over);
    ask(scene, changes, used, over);
    changes.apply(scene.world, coprocessor);
    scene.world.advance(dt);
    scene.move_arms(k);
    scene.world.motion().tick = k;
    scene.world.carry();
    const PairForces& forces = coprocessor.exchange();
    trace.near += forces.totals.near;
    Wrench sum;
    for (const BodyId tool : scene.tools) {
      sum += forces.on_body[static_cast<std::size_t>(tool.index)];
      sum += forces.from_own[static_cast<std::size_t>(tool.index)];
    }
    trace.on_tool.push_back(sum);
    if (!compare) continue;
    const std::vector<double> expected = largest_by_pair(scene.world);
    std::vector<char> is_seen(expected.size(), 0);
    coprocessor.for_each_near([&](const NearPair& near) {
      const auto i = static_cast<std::size_t>(near.pair.index);
      is_seen[i] = 1;
      EXPECT_FALSE(near.stale);
      const bool acts_at_all = acts(scene.world, near.pair, scene.world.motion());
      EXPECT_TRUE(acts_at_all) << "pair " << i << ", tick " << k;
      compared += expected[i] > 0.0 ? 1 : 0;
    });
    for (std::size_t i = 0; i < expected.size(); ++i) {
      EXPECT_TRUE(is_seen[i] == 1 || !(expected[i] > 1e-9)) << "pair " << i << ", tick " << k;
    }
  }
  trace.counts = changes.counts();
  EXPECT_TRUE(!compare || compared > ticks / 2) << "the sample has to mean something: " << compared;
  return trace;
}

// Each of these is the way of an arm and of parts that come and go by chance.
TEST(WorldChanges, LoseNoForceAndLeaveNone) {
  constexpr unsigned seed = 1993;
  const Trace trace = run(seed, draws(3000), {}, 0.02, true);
  RecordProperty("applied", static_cast<int>(trace.counts.applied));
  EXPECT_GT(trace.counts.applied, draws(1500)) << "seed " << seed;
  EXPECT_GT(trace.counts.refused, 0);
}

TEST(WorldChanges, GiveTheSameForcesHoweverManyThreads) {
  static constexpr unsigned seed = 29;
  const auto same = [](const Trace& a, const Trace& b) {
    ASSERT_EQ(a.on_tool.size(), b.on_tool.size());
    for (std::size_t k = 0; k < a.on_tool.size(); ++k) {
      ASSERT_EQ(std::memcmp(a.on_tool[k].force.data(), b.on_tool[k].force.data(), 24), 0)
          << "tick " << k << ", seed " << seed;
      ASSERT_EQ(std::memcmp(a.on_tool[k].torque.data(), b.on_tool[k].torque.data(), 24), 0);
    }
    EXPECT_EQ(a.counts.applied, b.counts.applied);
  };
  CoprocessorOptions options;
  options.lock_step = true;
  const Trace alone = run(seed, draws(4000), options, 0.05, false);
  options.threads = 2;
  same(alone, run(seed, draws(4000), options, 0.05, false));
  options.mode = CoprocessorMode::beside;
  const Trace beside = run(seed, draws(4000), options, 0.05, false);
  same(beside, run(seed, draws(4000), options, 0.05, false));
  EXPECT_GT(alone.near, draws(4000));
  EXPECT_GT(alone.counts.applied, draws(1900));
}

// What comes and goes over a time T changes the force of a pair by no more than the ceiling of its
// law times the share of T that a tick is, and what the law does by itself.
TEST(WorldChanges, KickNobody) {
  constexpr double over = 0.1;
  World world;
  const BodyId tool = world.add_body("tool");
  world.join(tool, tool);
  world.spare_held(tool);
  const PartId finger = world.add_part(tool, "finger", Shape::sphere(0.02, {.levels = 1}));
  const PartId part = world.reserve("box", Shape::box({0.05, 0.05, 0.05}, {.levels = 1}), 0.2);
  const PartId floor = world.add_part(World::fixed, "floor", Shape::box({1, 1, 0.1}, {.levels = 1}),
                                      Pose(Eigen::Translation3d(0, 0, -0.14)));
  (void)world.add_pair(finger, part, law);
  (void)world.add_pair(part, floor, law);
  Coprocessor coprocessor(world, {});
  // The tool is 10 mm inside of the part that comes, which is 10 mm inside of the floor.
  EXPECT_TRUE(world.place(tool, Pose(Eigen::Translation3d(0.06, 0, 0)), {}));
  Vec3 last(0, 0, 0);
  double largest = 0.0;
  double largest_step = 0.0;
  double supplied = 0.0;
  const auto run_for = [&](double time) {
    for (int k = 0; k < time / dt; ++k) {
      world.advance(dt);
      world.carry();
      const PairForces& forces = coprocessor.exchange();
      const Vec3 now = forces.on_body[static_cast<std::size_t>(tool.index)].force;
      largest_step = std::max(largest_step, (now - last).norm());
      largest = std::max(largest, now.norm());
      supplied += dt * forces.carried[static_cast<std::size_t>(tool.index)];
      last = now;
    }
  };
  EXPECT_TRUE(world.add(part, Pose::Identity(), over));
  run_for(0.2);
  EXPECT_GT(largest, 20.0) << "it pushes the tool out";
  EXPECT_NEAR(supplied, law.potential(-0.01), 1e-9) << "what pushing the tool out may cost";
  EXPECT_TRUE(world.attach(part, tool, over));
  run_for(0.1);
  EXPECT_LT(last.norm(), 1.0) << "no more an obstacle";
  run_for(0.3);
  EXPECT_GT(last.z(), 20.0) << "what is held is pushed out of the floor";
  EXPECT_TRUE(world.release(part, over));
  run_for(0.4);
  EXPECT_GT(last.x(), 20.0) << "an obstacle again";
  EXPECT_TRUE(world.remove(part, over));
  run_for(0.2);
  EXPECT_EQ(last.norm(), 0.0);
  EXPECT_NEAR(supplied, 0.0, 1e-9) << "what was supplied and not drawn is taken back";
  EXPECT_LE(largest_step, law.ceiling * dt / over * (1.0 + 1e-9));
}

TEST(WorldChanges, WaitUntilAPartIsFreeBeforeItGetsANewShape) {
  Scene scene(7);
  CoprocessorOptions options;
  options.threads = 1;
  options.lock_step = true;
  options.mode = CoprocessorMode::beside;
  Coprocessor coprocessor(scene.world, options);
  WorldChanges changes(scene.world);
  const auto tick = [&](int k) {
    changes.apply(scene.world, coprocessor);
    scene.world.advance(dt);
    scene.move_arms(k);
    (void)coprocessor.exchange();
  };
  std::vector<PartId> all;
  for (std::size_t i = 0; i < scene.loose.size(); ++i) {
    all.push_back(changes.add(Shape::sphere(0.05), Pose::Identity(), 0.0));
    EXPECT_TRUE(all.back().valid());
  }
  EXPECT_FALSE(changes.add(Shape::sphere(0.05), Pose::Identity(), 0.0).valid()) << "all are used";
  tick(0);
  EXPECT_EQ(changes.counts().applied, 8);
  EXPECT_TRUE(changes.remove(all[3], 10 * dt));
  EXPECT_FALSE(changes.add(Shape::sphere(0.2), Pose::Identity(), 0.0).valid()) << "too large";
  EXPECT_EQ(changes.add(Shape::sphere(0.06), Pose::Identity(), 0.0), all[3]);
  int k = 1;
  for (; k < 100 && changes.counts().applied < 10; ++k) tick(k);
  EXPECT_EQ(changes.counts().applied, 10);
  EXPECT_GT(changes.counts().waited, 8);
  EXPECT_LT(changes.counts().waited, 16);
  EXPECT_EQ(scene.world.part(all[3]).shape.reach(), 0.06);
  EXPECT_EQ(changes.counts().refused, 0);
}

/// One reserved part, which is there, and a queue for so many changes.
struct Queue {
  explicit Queue(std::size_t capacity) : changes(world, capacity) {}

  void tick(int ticks = 1) {
    for (int k = 0; k < ticks; ++k) {
      changes.apply(world, coprocessor);
      world.advance(dt);
      (void)coprocessor.exchange();
    }
  }
  World world;
  PartId part = world.reserve("spare", Shape::sphere(0.01, {.levels = 1}), 0.2);
  Coprocessor coprocessor{world, {}};
  WorldChanges changes;
  const Shape ball = Shape::sphere(0.1, {.levels = 1});
};

// A part that was to go in a time below 0 stayed, and what was to come in its place waited for it
// for ever, with everything behind it.
TEST(WorldChanges, ImpossibleNumbersAreRefusedAtOnceAndBlockNothing) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  constexpr double inf = std::numeric_limits<double>::infinity();
  Queue queue(8);
  WorldChanges& changes = queue.changes;
  const Pose here = Pose::Identity();
  Pose nowhere = here;
  nowhere.translation().x() = nan;
  for (const double over : {-1e-300, -1.0, nan, inf, 1e300}) {
    EXPECT_FALSE(changes.add(queue.ball, here, over).valid()) << over;
    EXPECT_FALSE(changes.add(queue.part, here, over)) << over;
  }
  EXPECT_FALSE(changes.add(queue.ball, nowhere).valid());
  EXPECT_FALSE(changes.add(queue.part, nowhere));
  ASSERT_EQ(changes.add(queue.ball, here, 0.0), queue.part) << "it is still free";
  queue.tick(3);
  for (const double over : {-1e-300, -1.0, nan, inf, 1e300}) {
    EXPECT_FALSE(changes.attach(queue.part, World::fixed, over)) << over;
    EXPECT_FALSE(changes.release(queue.part, over)) << over;
    EXPECT_FALSE(changes.remove(queue.part, over)) << over;
  }
  for (const double speed : {0.0, -1.0, nan, inf, 1e300, 1e-300}) {
    EXPECT_FALSE(changes.move(queue.part, here, speed)) << speed;
  }
  EXPECT_FALSE(changes.move(queue.part, nowhere));
  EXPECT_FALSE(changes.add(queue.ball, here).valid()) << "it is in use";
  queue.tick(3);
  EXPECT_EQ(changes.counts().applied, 1);
  EXPECT_EQ(changes.counts().refused, 0);
  EXPECT_TRUE(changes.remove(queue.part, 0.0));
  EXPECT_EQ(changes.add(queue.ball, here, 0.0), queue.part);
  queue.tick(10);
  EXPECT_EQ(changes.counts().applied, 3);
}

// A new shape for a part that is there and stays is refused; it does not wait for what never comes.
TEST(WorldChanges, WhatTheTickDoesToAPartItselfBlocksNothing) {
  Queue queue(8);
  ASSERT_EQ(queue.changes.add(queue.ball, Pose::Identity(), 0.0), queue.part);
  EXPECT_TRUE(queue.world.add(queue.part, Pose::Identity(), 0.0)) << "before its turn";
  queue.tick(5);
  EXPECT_EQ(queue.changes.counts().refused, 1);
  EXPECT_EQ(queue.changes.counts().waited, 0);
  EXPECT_TRUE(queue.changes.move(queue.part, Pose::Identity()));
  queue.tick();
  EXPECT_EQ(queue.changes.counts().applied, 1);
}

TEST(WorldChanges, FullQueueLosesNoPart) {
  Queue queue(1);
  const PartId other = queue.part;
  ASSERT_TRUE(queue.changes.move(other, Pose::Identity())) << "the queue is full now";
  EXPECT_FALSE(queue.changes.add(other, Pose::Identity()));
  EXPECT_FALSE(queue.changes.add(queue.ball, Pose::Identity()).valid());
  EXPECT_EQ(queue.changes.dropped(), 2);
  queue.tick();
  EXPECT_EQ(queue.changes.add(queue.ball, Pose::Identity()), other) << "it is still free";
}

// A box from a page once took the place of a crate that a script was to bring later.
TEST(WorldChanges, GiveNoNewShapeToAPartThatIsToKeepItsOwn) {
  World world;
  const Shape crate = Shape::sphere(0.2, {.levels = 1});
  const PartId kept = world.reserve("crate", crate, crate.reach());
  const PartId spare = world.reserve("spare", Shape::sphere(0.01, {.levels = 1}), 0.2);
  WorldChanges changes(world);
  const Shape box = Shape::box({0.1, 0.1, 0.1}, {.levels = 1});
  EXPECT_EQ(changes.add(box, Pose::Identity()), spare);
  EXPECT_FALSE(changes.add(box, Pose::Identity()).valid());
  EXPECT_TRUE(changes.add(kept, Pose::Identity())) << "as it is";
}

TEST(WorldChanges, TakePartsOfTheShareThatIsAskedFor) {
  World world;
  std::vector<PartId> all;
  for (int i = 0; i < 6; ++i) {
    all.push_back(world.reserve("spare", Shape::sphere(0.01, {.levels = 1}), 0.2));
  }
  WorldChanges changes(world);
  const Shape ball = Shape::sphere(0.1, {.levels = 1});
  const auto add = [&](const ReservedShare& share) {
    return changes.add(ball, Pose::Identity(), 0.0, share);
  };
  EXPECT_EQ(add({.first = 2, .count = 2}), all[2]);
  EXPECT_EQ(add({.first = 2, .count = 2}), all[3]);
  EXPECT_FALSE(add({.first = 2, .count = 2}).valid());
  EXPECT_EQ(add({.first = 4}), all[4]) << "and all behind it";
  EXPECT_EQ(add({}), all[0]);
  EXPECT_EQ(add({.first = 5, .count = 100}), all[5]);
  EXPECT_FALSE(add({.first = 6}).valid());
  EXPECT_TRUE(changes.remove(all[3], 0.0));
  EXPECT_FALSE(add({.first = 4}).valid());
  EXPECT_EQ(add({.first = 2, .count = 2}), all[3]);
}

TEST(WorldChanges, ComeFromAnotherThread) {
  Scene scene(3);
  Coprocessor coprocessor(scene.world, {});
  WorldChanges changes(scene.world, 8);
  std::atomic<bool> is_over{false};
  std::int64_t asked = 0;
  std::thread asking([&] {
    std::mt19937 random(11);
    while (asked < draws(2000)) {
      const PartId id =
          changes.add(random_shape(random, Scene::room), random_pose(random, 0.2), 0.0);
      if (!id.valid()) {  // the other thread is behind, as far as the machine lets it
        std::this_thread::yield();
        continue;
      }
      ++asked;
      while (!changes.remove(id, 0.0)) std::this_thread::yield();
      ++asked;
    }
    is_over = true;
  });
  for (int k = 0; !is_over || changes.counts().applied + changes.counts().refused < asked; ++k) {
    changes.apply(scene.world, coprocessor);
    scene.world.advance(dt);
    scene.move_arms(k);
    (void)coprocessor.exchange();
  }
  asking.join();
  EXPECT_EQ(changes.counts().applied, asked);
}

}  // namespace world_changes_test
}  // namespace repel
