// SPDX-License-Identifier: BSD-3-Clause
#include <repel/force/law.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <vector>

namespace repel {
namespace law_test {

constexpr unsigned seed = 1993;

double uniform(std::mt19937_64& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

std::vector<ForceLaw> random_laws(int count) {
  std::mt19937_64 random(seed);
  std::vector<ForceLaw> laws;
  for (int i = 0; i < count; ++i) {
    laws.push_back(
        {uniform(random, 1e-3, 0.1), uniform(random, 1.0, 500.0), uniform(random, 0.0, 300.0)});
    if (i % 3 == 0) laws.back().ceiling = uniform(random, 1.0, 1000.0);
  }
  return laws;
}

TEST(ForceLaw, RisesFromZeroWithZeroSlopeAtTheRange) {
  for (const ForceLaw& law : random_laws(50)) {
    EXPECT_EQ(law(law.range, 0.0), 0.0);
    EXPECT_EQ(law(2.0 * law.range, -1.0), 0.0);
    for (const double share : {1e-2, 1e-4, 1e-6}) {
      // A force of second order in the distance to the range limit.
      const double inside = law.spring(law.range * (1.0 - share));
      EXPECT_NEAR(inside, law.surface_force * share * share,
                  1e-9 * law.surface_force * share * share + 1e-15 * law.surface_force)
          << "seed " << seed;
      EXPECT_GT(inside, 0.0);
    }
  }
}

TEST(ForceLaw, IsSmoothAtTheSurface) {
  for (const ForceLaw& law : random_laws(50)) {
    const double h = 1e-5 * law.range;
    EXPECT_NEAR(law.spring(0.0), law.surface_force, 1e-12 * law.surface_force);
    const double outside = (law.spring(0.0) - law.spring(h)) / h;
    const double inside = (law.spring(-h) - law.spring(0.0)) / h;
    EXPECT_NEAR(outside, inside, 1e-4 * law.stiffness()) << "seed " << seed;
    EXPECT_NEAR(inside, law.stiffness(), 1e-4 * law.stiffness());
  }
}

TEST(ForceLaw, GrowsWithIntrusionAndHasNoJump) {
  for (const ForceLaw& law : random_laws(50)) {
    const double step = law.range / 1000.0;
    double last = 0.0;
    for (double d = 1.2 * law.range; d > -3.0 * law.range; d -= step) {
      const double f = law.spring(d);
      ASSERT_GE(f, last) << "at " << d << ", seed " << seed;
      ASSERT_LE(f - last, 1.0001 * law.stiffness() * step) << "at " << d << ", seed " << seed;
      last = f;
    }
    EXPECT_GT(last, law.surface_force);
  }
}

TEST(ForceLaw, NeverPullsAndNeverExceedsItsCeiling) {
  std::mt19937_64 random(seed);
  int limited = 0;
  for (const ForceLaw& law : random_laws(100)) {
    for (int i = 0; i < 200; ++i) {
      const double f = law(uniform(random, -3.0, 1.5) * law.range, uniform(random, -10.0, 10.0));
      ASSERT_GE(f, 0.0) << "seed " << seed;
      ASSERT_LE(f, law.ceiling) << "seed " << seed;
      limited += f == law.ceiling ? 1 : 0;
    }
  }
  EXPECT_GT(limited, 100) << "the sample does not reach the ceiling, seed " << seed;
}

TEST(ForceLaw, RetreatNeverMeetsMoreForceThanRest) {
  std::mt19937_64 random(seed);
  for (const ForceLaw& law : random_laws(100)) {
    for (int i = 0; i < 100; ++i) {
      const double d = uniform(random, -2.0, 1.0) * law.range;
      const double rate = uniform(random, 0.0, 5.0);
      ASSERT_LE(law(d, rate), law(d, 0.0)) << "seed " << seed;
      ASSERT_GE(law(d, -rate), law(d, 0.0)) << "seed " << seed;
    }
  }
}

TEST(ForceLaw, DampingBeginsAtZeroAtTheRangeAndIsFullFromTheSurfaceOn) {
  const ForceLaw law{.range = 0.02, .surface_force = 100.0, .damping = 50.0};
  EXPECT_EQ(law.formula().damper(0.02), 0.0);
  EXPECT_EQ(law.formula().damper(0.03), 0.0);
  EXPECT_NEAR(law.formula().damper(0.01), 25.0, 1e-12);
  EXPECT_EQ(law.formula().damper(0.0), 50.0);
  EXPECT_EQ(law.formula().damper(-0.01), 50.0);
}

TEST(ForceLaw, SpringGivesBackOnAClosedPathWhatItTook) {
  for (const ForceLaw& law : random_laws(20)) {
    // Once in and out again, deep enough for both branches; work by Simpson's rule.
    constexpr int steps = 20000;
    const auto distance = [&](double s) {
      return law.range * (0.25 + 1.25 * std::cos(2.0 * std::numbers::pi * s)) +
             0.1 * law.range * std::sin(6.0 * std::numbers::pi * s);
    };
    double work = 0.0;
    double flow = 0.0;
    for (int i = 0; i < steps; ++i) {
      const double a = distance(static_cast<double>(i) / steps);
      const double b = distance(static_cast<double>(i + 1) / steps);
      const double mean = (law.spring(a) + 4.0 * law.spring(0.5 * (a + b)) + law.spring(b)) / 6.0;
      work += mean * (b - a);
      flow += std::abs(mean * (b - a));
    }
    EXPECT_GT(flow, 0.1 * law.surface_force * law.range);
    EXPECT_NEAR(work, 0.0, 1e-9 * flow) << "seed " << seed;
  }
}

// The spring force is the slope of the potential: the difference between two distances is the work.
TEST(ForceLaw, PotentialIsTheWorkOfTheSpringUpToItsCeiling) {
  for (const double ceiling : {40.0, 100.0, 250.0, std::numeric_limits<double>::infinity()}) {
    const ForceLaw law{.range = 0.02, .surface_force = 100.0, .damping = 0.0, .ceiling = ceiling};
    EXPECT_EQ(law.potential(law.range), 0.0);
    EXPECT_EQ(law.potential(1.0), 0.0);
    constexpr double step = 1e-6;
    double work = 0.0;
    for (double d = law.range; d > -0.05; d -= step) {
      work += step * law(d - 0.5 * step, 0.0);
      ASSERT_NEAR(law.potential(d - step), work, 1e-7 + 1e-6 * work)
          << "at " << d << " m, ceiling " << ceiling << " N";
    }
    EXPECT_GT(work, 1.0);
  }
}

TEST(ForceLaw, DamperOnlyTakesEnergy) {
  ForceLaw law{.range = 0.02, .surface_force = 100.0, .damping = 80.0};
  constexpr int steps = 20000;
  constexpr double T = 1.0 / steps;
  double work = 0.0;  // done by the force on the body
  for (int i = 0; i < steps; ++i) {
    const double s = 2.0 * std::numbers::pi * (i + 0.5) / steps;
    const double d = 0.02 * (0.3 + std::cos(s));
    const double rate = -0.02 * 2.0 * std::numbers::pi * std::sin(s);
    work += T * law(d, rate) * rate;
  }
  EXPECT_LT(work, -0.01);
}

/// Random passable laws, each of a pair that can be as deep as the law states.
std::vector<ForceLaw> random_passable_laws(int count) {
  std::mt19937_64 random(seed);
  std::vector<ForceLaw> laws = random_laws(count);
  for (ForceLaw& law : laws) {
    law.passable = true;
    law.ceiling = uniform(random, 0.01, 0.5) * law.surface_force;
    law.depth = uniform(random, 0.0, 3.0) * law.range;
    law.plateau = uniform(random, 0.0, 1.0);
  }
  laws.front().depth = 0.0;
  return laws;
}

TEST(ForceLaw, PassableRisesToItsCeilingAndFallsToZeroNowhereSteeperThanItsStiffness) {
  for (const ForceLaw& law : random_passable_laws(100)) {
    const double step = law.range / 2000.0;
    double last = 0.0;
    double peak = 0.0;
    bool falls = false;
    for (double d = 1.1 * law.range; d > -law.depth - law.range; d -= step) {
      const double f = law(d, 0.0);
      ASSERT_LE(std::abs(f - last), 1.0001 * law.stiffness() * step) << d << ", seed " << seed;
      falls = falls || f < last;
      ASSERT_TRUE(!falls || f <= last) << "rises again at " << d << ", seed " << seed;
      peak = std::max(peak, f);
      last = f;
    }
    EXPECT_EQ(peak, law.ceiling) << "seed " << seed;
    EXPECT_EQ(law(-law.depth, -1.0), 0.0);
    EXPECT_EQ(last, 0.0);
  }
}

TEST(ForceLaw, PassableHoldsItsCeilingUpToThePlateau) {
  ForceLaw law{.range = 0.01, .surface_force = 20.0, .ceiling = 5.0, .passable = true};
  law.depth = 0.06;
  EXPECT_EQ(law(0.0, 0.0), 5.0);
  EXPECT_EQ(law(-0.03, 0.0), 5.0);
  EXPECT_NEAR(law(-0.045, 0.0), 2.5, 1e-12);
  law.plateau = 0.75;
  EXPECT_EQ(law(-0.045, 0.0), 5.0);
  law.depth = 0.0;  // a sheet: the force must have fallen to zero at the surface
  EXPECT_EQ(law(0.0, 0.0), 0.0);
  EXPECT_EQ(law(5.0 / law.stiffness(), 0.0), 5.0);
}

TEST(ForceLaw, PassableIsDampedInProportionToItsSpring) {
  ForceLaw law{
      .range = 0.01, .surface_force = 20.0, .damping = 10.0, .ceiling = 5.0, .passable = true};
  law.depth = 0.06;
  EXPECT_EQ(law(-0.01, -1.0), 5.0) << "above the ceiling";
  EXPECT_NEAR(law(-0.01, 0.1), 4.0, 1e-12);
  EXPECT_NEAR(law(-0.045, 0.1), 2.0, 1e-12);
  EXPECT_NEAR(law(-0.045, -0.1), 3.0, 1e-12);
  EXPECT_EQ(law(-0.045, 10.0), 0.0);
}

TEST(ForceLaw, AWallKnowsNothingOfPassage) {
  std::mt19937_64 random(seed);
  for (ForceLaw law : random_laws(100)) {
    law.depth = uniform(random, 0.0, 0.1);
    law.plateau = uniform(random, 0.0, 1.0);
    for (int i = 0; i < 100; ++i) {
      const double d = uniform(random, -3.0, 1.5) * law.range;
      const double rate = uniform(random, -10.0, 10.0);
      const double inward = 1.0 - d / law.range;
      const double spring = d > 0.0 ? law.surface_force * inward * inward
                                    : law.surface_force * (1.0 - 2.0 * d / law.range);
      const double damper = law.damping * std::clamp(inward, 0.0, 1.0);
      const double f = std::clamp(spring - damper * rate, 0.0, law.ceiling);
      ASSERT_EQ(law(d, rate), d < law.range ? f : 0.0) << "seed " << seed;
    }
  }
}

TEST(ForceLaw, DistanceThatIsNotANumberGivesNoForce) {
  EXPECT_EQ(ForceLaw{}(std::nan(""), 0.0), 0.0);
}

TEST(ForceLaw, CheckedNamesTheFieldItRefuses) {
  const double nan = std::nan("");
  const double infinity = std::numeric_limits<double>::infinity();
  struct Bad {
    const char* name;
    double ForceLaw::*field;
    std::vector<double> values;
  };
  const Bad bad[] = {{"range", &ForceLaw::range, {0.0, -1.0, nan, infinity}},
                     {"surface force", &ForceLaw::surface_force, {-1.0, nan, infinity}},
                     {"damping", &ForceLaw::damping, {-1e-9, nan, infinity}},
                     {"ceiling", &ForceLaw::ceiling, {-1.0, nan}},
                     {"depth", &ForceLaw::depth, {-1e-9, nan, infinity}},
                     {"plateau", &ForceLaw::plateau, {-0.1, 1.1, nan}}};
  for (const Bad& b : bad) {
    for (const double value : b.values) {
      ForceLaw law;
      law.*b.field = value;
      try {
        checked(law);
        ADD_FAILURE() << b.name << " " << value << " was accepted";
      } catch (const SetupError& error) {
        EXPECT_EQ(std::string(error.what()).find(b.name), 0U) << error.what();
        EXPECT_NE(std::string(error.what()).find("allowed: "), std::string::npos) << error.what();
      }
    }
  }
  EXPECT_NO_THROW(checked(ForceLaw{}));
  EXPECT_NO_THROW(checked(ForceLaw{.range = 0.01, .surface_force = 0.0, .damping = 0.0}));
}

TEST(ForceLaw, CheckedAsksOfAPassableBodyACeilingOfUpToHalfTheSurfaceForce) {
  ForceLaw law{.surface_force = 20.0, .passable = true};
  for (const double ceiling : {std::numeric_limits<double>::infinity(), 10.1, 0.0}) {
    law.ceiling = ceiling;
    try {
      checked(law);
      ADD_FAILURE() << ceiling << " was accepted";
    } catch (const SetupError& error) {
      EXPECT_NE(std::string(error.what()).find("ceiling of a passable body"), std::string::npos);
      EXPECT_NE(std::string(error.what()).find("allowed: 1e-09 to 10 N"), std::string::npos)
          << error.what();
    }
  }
  law.ceiling = 10.0;
  EXPECT_NO_THROW(checked(law));
}

TEST(ForceLaw, IsNowhereLessDampedForItsSlopeThanItTellsTheStabilityCheck) {
  const ForceLaw law{.range = 0.03, .surface_force = 200.0, .damping = 70.0};
  const LawFormula<double> formula = law.formula();
  const double told = law.steepest_damping() / law.stiffness();
  constexpr double step = 1e-7;
  for (double d = -2.0 * law.range; d < 0.99 * law.range; d += 1e-3 * law.range) {
    const double slope = (formula.spring(d - step) - formula.spring(d + step)) / (2.0 * step);
    EXPECT_LE(slope, law.stiffness() * (1.0 + 1e-6)) << d;
    EXPECT_GE(formula.damper(d) / slope, told * (1.0 - 1e-6)) << d;
  }
}

}  // namespace law_test
}  // namespace repel
