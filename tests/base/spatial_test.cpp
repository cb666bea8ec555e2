// SPDX-License-Identifier: BSD-3-Clause
// Identities of twists and wrenches on random samples.
#include <repel/base/spatial.hpp>

#include <gtest/gtest.h>

#include <limits>
#include <string>

#include <support/families.hpp>

namespace repel {
namespace spatial_test {

using families::Rng;
using families::rotation;

constexpr unsigned seed = 17;

struct Sample {
  Wrench F;
  Twist V;
  Vec3 p, q;  ///< [m]
  Mat3 R;
};

Vec3 vector(Rng& rng) {
  return families::log_uniform(rng, 0.1, 10.0) * families::direction(rng);
}

template <class Law>
void for_samples(Law&& law) {
  Rng rng(seed);
  for (int i = 0; i < 200; ++i) {
    SCOPED_TRACE(families::of_seed(seed, "sample", i));
    law(Sample{{vector(rng), vector(rng)},
               {vector(rng), vector(rng)},
               vector(rng),
               vector(rng),
               rotation(rng)});
  }
}

void expect_equal(const Vec3& a, const Vec3& b) {
  EXPECT_LE((a - b).norm(), 1e-13 * (1.0 + a.norm() + b.norm()) * 10.0)
      << a.transpose() << " and " << b.transpose();
}
void expect_equal(const Wrench& a, const Wrench& b) {
  expect_equal(a.force, b.force);
  expect_equal(a.torque, b.torque);
}
void expect_equal(const Twist& a, const Twist& b) {
  expect_equal(a.linear, b.linear);
  expect_equal(a.angular, b.angular);
}

TEST(Spatial, PowerIsTheSameAboutEveryPoint) {
  for_samples([](const Sample& s) {
    EXPECT_NEAR(power(moved_to(s.F, s.p), moved_to(s.V, s.p)), power(s.F, s.V), 1e-10);
  });
}

TEST(Spatial, PowerIsTheSameInEveryFrame) {
  for_samples([](const Sample& s) {
    EXPECT_NEAR(power(rotated(s.R, s.F), rotated(s.R, s.V)), power(s.F, s.V), 1e-11);
  });
}

TEST(Spatial, MovingThereAndBackChangesNothing) {
  for_samples([](const Sample& s) {
    expect_equal(moved_to(moved_to(s.F, s.p), -s.p), s.F);
    expect_equal(moved_to(moved_to(s.V, s.p), -s.p), s.V);
  });
}

TEST(Spatial, TwoMovesAreOneMoveByTheirSum) {
  for_samples([](const Sample& s) {
    expect_equal(moved_to(moved_to(s.F, s.p), s.q), moved_to(s.F, s.p + s.q));
    expect_equal(moved_to(moved_to(s.V, s.p), s.q), moved_to(s.V, s.p + s.q));
  });
}

TEST(Spatial, MovingAndRotatingCommute) {
  for_samples([](const Sample& s) {
    expect_equal(rotated(s.R, moved_to(s.F, s.p)), moved_to(rotated(s.R, s.F), s.R * s.p));
    expect_equal(rotated(s.R, moved_to(s.V, s.p)), moved_to(rotated(s.R, s.V), s.R * s.p));
  });
}

TEST(Spatial, AForceHasNoTorqueAboutItsOwnPoint) {
  for_samples([](const Sample& s) {
    const Wrench F_P = wrench_of_force(s.F.force, s.p);
    expect_equal(moved_to(F_P, s.p), Wrench{s.F.force, Vec3::Zero()});
  });
}

TEST(Spatial, TheTorqueOfAForceTurnsByTheRightHand) {
  const Wrench F = wrench_of_force(Vec3::UnitY(), 2.0 * Vec3::UnitX());
  expect_equal(F, Wrench{Vec3::UnitY(), 2.0 * Vec3::UnitZ()});
}

TEST(Spatial, APointAheadOfATurningBodyMovesSideways) {
  const Twist V{Vec3::Zero(), 3.0 * Vec3::UnitZ()};
  expect_equal(moved_to(V, 2.0 * Vec3::UnitX()), Twist{6.0 * Vec3::UnitY(), V.angular});
}

TEST(Spatial, SumsAndMultiplesAreTakenPartByPart) {
  for_samples([](const Sample& s) {
    const Wrench F{s.p, s.q};
    EXPECT_NEAR(power(2.5 * s.F + F, s.V), 2.5 * power(s.F, s.V) + power(F, s.V), 1e-10);
    const Twist V{s.p, s.q};
    EXPECT_NEAR(power(s.F, 2.5 * s.V + V), 2.5 * power(s.F, s.V) + power(s.F, V), 1e-10);
  });
}

TEST(Spatial, OneEntryThatIsNotFiniteSpoilsTheWhole) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(is_finite(Wrench{}));
  EXPECT_TRUE(is_finite(Twist{}));
  EXPECT_FALSE(is_finite(Wrench{Vec3(0, nan, 0), Vec3::Zero()}));
  EXPECT_FALSE(is_finite(Wrench{Vec3::Zero(), Vec3(nan, 0, 0)}));
  EXPECT_FALSE(is_finite(Twist{Vec3(0, nan, 0), Vec3::Zero()}));
  EXPECT_FALSE(is_finite(Twist{Vec3::Zero(), Vec3(nan, 0, 0)}));
}

}  // namespace spatial_test
}  // namespace repel
