// SPDX-License-Identifier: BSD-3-Clause
#include <repel/contact/patch.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include <repel/force/law.hpp>

#include "contact/contacts.hpp"

namespace repel {
namespace patch_test {

using families::Rng;
using test::Contact;
using test::Contacts;

constexpr unsigned seed = 22;

std::string of_pair(const std::pair<std::string, std::string>& kinds, int i) {
  return kinds.first + " on " + kinds.second + ", " + families::of_seed(seed, "pair", i);
}

bool is_exact(const std::pair<std::string, std::string>& kinds) {
  const auto is_round = [](const std::string& kind) { return kind == "cap" || kind == "cone"; };
  return !is_round(kinds.first) && !is_round(kinds.second);
}

/// Where other faces are hardly apart, the tilt is less, and the wrench turns as much faster.
bool is_shallow(const std::pair<std::string, std::string>& kinds) {
  return kinds.first == "cloud";
}

bool is_rod_on_edges(const std::pair<std::string, std::string>& kinds) {
  return kinds.second == "box" && (kinds.first == "capsule" || kinds.first == "side");
}

double difference(const Wrench& F, const Wrench& G) {
  return (F.force - G.force).norm() + (F.torque - G.torque).norm();
}

TEST(Patch, WhereFeaturesAreNotParallelThePointIsTheNearest) {
  Rng rng(seed);
  for (int i = 0; i < 2000; ++i) {
    SCOPED_TRACE(families::of_seed(seed, "pair", i));
    Contacts pair{Shape::box({0.05, 0.06, 0.07}), Shape::box({0.2, 0.3, 0.04})};
    pair.X_WA.linear() = families::rotation(rng);
    pair.X_WA.translation() = Vec3(0.0, 0.0, 0.16);
    const Separation s = separation(pair.A, pair.X_WA, pair.B, pair.X_WB);
    double least = 1.0;
    for (int k = 0; k < 3; ++k) least = std::min(least, std::abs(pair.X_WA.linear()(2, k)));
    if (least < detail::flat_within(pair.tilt)) continue;
    ContactPatch patch;
    patch.nearer = -1.0;
    EXPECT_FALSE(find_patch(s, {pair.A, pair.X_WA}, {pair.B, pair.X_WB}, pair.tilt, patch));
    EXPECT_EQ(patch.nearer, -1.0);
  }
}

TEST(Patch, PressesInTheMiddleOfParallelFaces) {
  Contacts pair{Shape::box({0.05, 0.06, 0.01}), Shape::box({0.2, 0.3, 0.04})};
  pair.X_WA.translation() = Vec3(0.03, -0.02, 0.055);
  const Contact held = pair.find();
  ASSERT_TRUE(held.has_patch);
  EXPECT_LE((held.gradient.force - Vec3(0, 0, 1)).norm(), 1e-12);
  EXPECT_LE(held.gradient.torque.norm(), 1e-12);
  EXPECT_NEAR(held.distance, 0.005, 1e-15);
}

TEST(Patch, IsHardlyNearerOrFartherThanTheNearestPoint) {
  Rng rng(seed);
  int found = 0;
  for (const auto& kinds : test::kinds_of_contacts()) {
    for (int i = 0; i < 200; ++i) {
      SCOPED_TRACE(of_pair(kinds, i));
      const Contacts pair = test::draw_contacts(kinds, families::uniform(rng, 0.001, 0.01), rng);
      const double d = separation(pair.A, pair.X_WA, pair.B, pair.X_WB).distance;
      const Contact contact = pair.find();
      const double radius = std::min(pair.A.reach(), pair.B.reach());
      EXPECT_NEAR(contact.distance, d, 4.0 / 3.0 * pair.tilt * radius);
      EXPECT_NEAR(contact.gradient.force.norm(), 1.0, 0.01);
      found += contact.has_patch ? 1 : 0;
    }
  }
  EXPECT_GT(found, 2000);
}

TEST(Patch, IsTheSameForTheOtherShape) {
  Rng rng(seed);
  for (const auto& kinds : test::kinds_of_contacts()) {
    for (const double gap : {0.006, -0.003}) {
      for (int i = 0; i < 100; ++i) {
        SCOPED_TRACE(of_pair(kinds, i));
        const Contacts pair = test::draw_contacts(kinds, gap, rng);
        const Contact one = pair.find();
        const Contact other = pair.swapped().find();
        const Vec3 p_BA = origin(pair.X_WA) - origin(pair.X_WB);
        const Wrench opposite{-other.gradient.force,
                              -other.gradient.torque + p_BA.cross(other.gradient.force)};
        const bool exact = is_exact(kinds) && !(is_shallow(kinds) && gap < 0.0);
        EXPECT_NEAR(one.distance, other.distance, exact ? 1e-9 : 1e-5);
        // Where a corner lies on an edge, rounding decides which side of A or B bounds the patch:
        // the pull along the plane, of the size of the tilt, may then be split otherwise.
        EXPECT_LE(difference(one.gradient, opposite), is_exact(kinds) ? pair.tilt : 0.05);
      }
    }
  }
}

TEST(Patch, DoesNotDependOnTheFrameOfTheWorld) {
  Rng rng(seed);
  for (const auto& kinds : test::kinds_of_contacts()) {
    for (int i = 0; i < 100; ++i) {
      SCOPED_TRACE(of_pair(kinds, i));
      const Contacts pair = test::draw_contacts(kinds, 0.006, rng);
      const Pose X_VW = families::random_pose(rng, -2.0, 2.0);
      Contacts turned = pair;
      turned.X_WA = X_VW * pair.X_WA;
      turned.X_WB = X_VW * pair.X_WB;
      const Contact here = pair.find();
      const Contact there = turned.find();
      const Wrench back{X_VW.linear().transpose() * there.gradient.force,
                        X_VW.linear().transpose() * there.gradient.torque};
      EXPECT_NEAR(here.distance, there.distance, is_exact(kinds) ? 1e-9 : 1e-5);
      EXPECT_LE(difference(here.gradient, back), is_exact(kinds) ? 1e-5 : 0.05);
    }
  }
}

/// What a random motion of tiny steps did.
struct Walk {
  int steps = 0;
  int leaps = 0;       ///< of the nearest point, by more than a centimetre
  int quick = 0;       ///< steps that change the gradient's torque by more than a millimetre
  double arm = 0.0;    ///< [m] largest change of the gradient's torque per step
  double force = 0.0;  ///< largest change of its force per step
  double wrong = 0.0;  ///< largest error of the gradient against the change of distance, per step
  int off = 0;         ///< steps with an error above 0.6
};

// One micrometre and 20 microradians per step. The nearest point leaps from corner to corner; the
// patch does not, nor its distance where another face of a hull becomes the flattest.
void walk(Contacts pair, Rng& rng, int steps, Walk& seen) {
  constexpr double step = 1e-6;
  const Vec3 d = step * families::direction(rng);
  const Vec3 turn = step / 0.05 * families::direction(rng);
  WarmStart warm;
  Contact before = pair.find(warm);
  Vec3 nearest = separation(pair.A, pair.X_WA, pair.B, pair.X_WB).p_WA;
  for (int i = 0; i < steps; ++i) {
    pair = pair.moved(d, turn);
    const Contact now = pair.find(warm);
    const Vec3 point = separation(pair.A, pair.X_WA, pair.B, pair.X_WB).p_WA;
    const Vec3 force = 0.5 * (now.gradient.force + before.gradient.force);
    const Vec3 torque = 0.5 * (now.gradient.torque + before.gradient.torque);
    const double change = now.distance - before.distance;
    seen.arm = std::max(seen.arm, (now.gradient.torque - before.gradient.torque).norm());
    seen.force = std::max(seen.force, (now.gradient.force - before.gradient.force).norm());
    const double wrong = std::abs(change - force.dot(d) - torque.dot(turn)) / step;
    seen.wrong = std::max(seen.wrong, wrong);
    seen.off += wrong > 0.6 ? 1 : 0;
    seen.quick += (now.gradient.torque - before.gradient.torque).norm() > 1e-3 ? 1 : 0;
    seen.leaps += (point - nearest).norm() > 0.01 ? 1 : 0;
    ++seen.steps;
    before = now;
    nearest = point;
  }
}

TEST(Patch, WrenchIsLipschitzInTheMotionAndTheGradientOfItsDistance) {
  Rng rng(seed);
  Walk all;
  for (const auto& kinds : test::kinds_of_contacts()) {
    if (!is_exact(kinds)) continue;
    Walk seen;
    for (int i = 0; i < 100; ++i) {
      walk(test::draw_contacts(kinds, families::uniform(rng, 0.002, 0.01), rng), rng, 400, seen);
    }
    EXPECT_LE(seen.quick, is_shallow(kinds) ? seen.steps / 100 : 0)
        << kinds.first << " on " << kinds.second << ", seed " << seed;
    EXPECT_LE(seen.force, 0.02) << kinds.first << " on " << kinds.second << ", seed " << seed;
    // A rod nearly along the edge of a box may find its face to be flat from one step to the next:
    // then the distance jumps by micrometres.
    EXPECT_LE(seen.off, is_rod_on_edges(kinds) ? seen.steps / 20000 : 0)
        << kinds.first << " on " << kinds.second << ", seed " << seed;
    EXPECT_LE(seen.wrong, is_rod_on_edges(kinds) ? 30.0 : 0.6)
        << kinds.first << " on " << kinds.second << ", seed " << seed;
    all.steps += seen.steps;
    all.leaps += seen.leaps;
  }
  EXPECT_GE(all.steps, 300'000);
  EXPECT_GT(all.leaps, 15);
}

/// A closed path through poses around a contact, and the work of a wall without damping along it.
struct Loop {
  Contacts start;
  Vec3 d1, d2, turn1, turn2;  ///< [m], [rad] half axes of the path

  [[nodiscard]] Contacts at(double angle) const {
    const double c = 1.0 - std::cos(angle);
    const double s = std::sin(angle);
    return start.moved(c * d1 + s * d2, c * turn1 + s * turn2);
  }
  struct Work {
    double net = 0.0;    ///< [J] around the path
    double there = 0.0;  ///< [J] its magnitude, both ways
  };
  [[nodiscard]] Work around(const ForceLaw& law, int steps) const {
    Work work;
    WarmStart warm;
    Contacts pair = at(0.0);
    Contact before = pair.find(warm);
    for (int i = 1; i <= steps; ++i) {
      const Contacts next = at(2.0 * M_PI * i / steps);
      const Contact now = next.find(warm);
      const Vec3 d = origin(next.X_WA) - origin(pair.X_WA);
      const Eigen::AngleAxisd turned(next.X_WA.linear() * pair.X_WA.linear().transpose());
      const Vec3 turn = turned.angle() * turned.axis();
      const auto done = [&](const Contact& c) {
        return law(c.distance, 0.0) * (c.gradient.force.dot(d) + c.gradient.torque.dot(turn));
      };
      const double part = 0.5 * (done(before) + done(now));
      work.net += part;
      work.there += std::abs(part);
      pair = next;
      before = now;
    }
    return work;
  }
};

// A wall returns what was put in, whichever way the contact went, and the nearest point does not.
TEST(Patch, AClosedPathReturnsTheWorkOfItsFirstHalf) {
  Rng rng(seed);
  const ForceLaw law{.range = 0.02, .surface_force = 200.0, .damping = 0.0};
  double net = 0.0;
  double there = 0.0;
  double largest = 0.0;
  for (const auto& kinds : test::kinds_of_contacts()) {
    if (!is_exact(kinds)) continue;
    for (int i = 0; i < 10; ++i) {
      SCOPED_TRACE(of_pair(kinds, i));
      Loop loop{test::draw_contacts(kinds, 0.009, rng), {}, {}, {}, {}};
      loop.d1 = 0.002 * families::direction(rng);
      loop.d2 = 0.004 * families::direction(rng);
      loop.turn1 = 0.01 * families::direction(rng);
      loop.turn2 = 0.01 * families::direction(rng);
      const Loop::Work work = loop.around(law, 4000);
      EXPECT_LE(std::abs(work.net), 5e-3 * work.there);
      net += std::abs(work.net);
      there += work.there;
      largest = std::max(largest, work.there);
    }
  }
  EXPECT_LE(net, 2e-4 * there) << net << " of " << there << " J";
  EXPECT_GT(largest, 0.1);
}

TEST(Patch, OverlapByEveryMeasureHasOne) {
  Rng rng(seed);
  for (const Measure measure : {Measure::deepest_point, Measure::exact, Measure::reduction}) {
    Walk seen;
    for (int i = 0; i < 100; ++i) {
      Contacts pair{Shape::box({0.05, 0.04, 0.03}), Shape::box({0.3, 0.3, 0.1})};
      pair.X_WA.translation() = Vec3(0.02, 0.03, 0.125);
      const Vec3 turn = 1e-5 * families::direction(rng);
      pair = pair.moved(Vec3::Zero(), -200.0 * turn);
      WarmStart warm;
      Contact before = pair.find(warm, measure);
      ASSERT_LT(before.distance, -0.003);
      for (int k = 0; k < 400; ++k) {
        pair = pair.moved(Vec3::Zero(), turn);
        const Contact now = pair.find(warm, measure);
        ASSERT_TRUE(now.has_patch);
        seen.arm = std::max(seen.arm, (now.gradient.torque - before.gradient.torque).norm());
        before = now;
      }
    }
    EXPECT_LE(seen.arm, 1e-3) << "seed " << seed;
  }
}

TEST(Patch, NoDirectionAndNoShapesHaveNone) {
  const Shape box = Shape::box({0.1, 0.1, 0.1});
  Pose far = Pose::Identity();
  far.translation().z() = std::nan("");
  const Separation s = separation(box, far, box, Pose::Identity());
  ContactPatch patch;
  EXPECT_FALSE(find_patch(s, {box, far}, {box, Pose::Identity()}, 0.005, patch));
  EXPECT_EQ(patch.nearer, 0.0);
}

}  // namespace patch_test
}  // namespace repel
