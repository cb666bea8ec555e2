// SPDX-License-Identifier: BSD-3-Clause
// Every operation compared with 113-bit arithmetic, which has 7 bits more than the guaranteed
// precision.
#include <repel/base/double_double.hpp>

#include <gtest/gtest.h>

#include <string>

#include <support/families.hpp>
#include <support/oracle.hpp>

namespace repel {
namespace double_double_test {

using families::Rng;
using oracle::magnitude;
using oracle::Real;

constexpr unsigned seed = 31;

Real real(DoubleDouble a) {
  return Real(a.hi) + Real(a.lo);
}

DoubleDouble random_value(Rng& rng) {
  const double hi = families::uniform(rng, -1.0, 1.0) * families::log_uniform(rng, 1e-20, 1e20);
  return DoubleDouble::sum(hi, hi * families::uniform(rng, -1.0, 1.0) * 0x1p-54);
}

/// The error of `result` relative to `scale`; the test fails unless it is below 2^-98.
void expect_right(DoubleDouble result, Real truth, Real scale) {
  const Real error = magnitude(real(result) - truth);
  EXPECT_LE(static_cast<double>(error / scale), 0x1p-98);
}

template <class Law>
void for_pairs(Law&& law) {
  Rng rng(seed);
  for (int i = 0; i < 20000; ++i) {
    const DoubleDouble a = random_value(rng);
    // Every third pair nearly cancels, every fifth is nearly equal.
    DoubleDouble b = random_value(rng);
    if (i % 3 == 0) b = DoubleDouble::sum(-a.hi * (1.0 + 0x1p-40), 0.3 * a.lo);
    if (i % 5 == 0) b = DoubleDouble::sum(a.hi, a.lo * 0.5);
    law(a, b);
    if (::testing::Test::HasFailure()) {
      ADD_FAILURE() << "seed " << seed << ", pair " << i;
      return;
    }
  }
}

TEST(DoubleDouble, SumsAreRightTo98Bits) {
  for_pairs([](DoubleDouble a, DoubleDouble b) {
    expect_right(a + b, real(a) + real(b), magnitude(real(a)) + magnitude(real(b)));
    expect_right(a - b, real(a) - real(b), magnitude(real(a)) + magnitude(real(b)));
  });
}

TEST(DoubleDouble, ADifferenceOfCloseValuesIsRightRelativeToItself) {
  Rng rng(seed);
  for (int i = 0; i < 20000; ++i) {
    const DoubleDouble a = random_value(rng);
    const DoubleDouble b = DoubleDouble::sum(a.hi, a.hi * families::log_uniform(rng, 1e-16, 1e-3));
    // Part by part: the sum of the low parts may be below the 113-bit resolution of the whole.
    const Real truth = (Real(a.hi) - Real(b.hi)) + (Real(a.lo) - Real(b.lo));
    if (truth == 0) continue;
    ASSERT_LE(static_cast<double>(magnitude((real(a - b) - truth) / truth)), 0x1p-98)
        << "seed " << seed << ", pair " << i;
  }
}

TEST(DoubleDouble, ProductsAreRightTo98Bits) {
  for_pairs([](DoubleDouble a, DoubleDouble b) {
    expect_right(a * b, real(a) * real(b), magnitude(real(a) * real(b)));
  });
}

TEST(DoubleDouble, QuotientsAreRightTo98Bits) {
  for_pairs([](DoubleDouble a, DoubleDouble b) {
    expect_right(a / b, real(a) / real(b), magnitude(real(a) / real(b)));
  });
}

TEST(DoubleDouble, SquareRootsAreRightTo98Bits) {
  for_pairs([](DoubleDouble a, DoubleDouble) {
    const DoubleDouble square = a.hi < 0.0 ? -a : a;
    const Real truth = oracle::square_root(real(square));
    expect_right(sqrt(square), truth, truth);
  });
}

TEST(DoubleDouble, TheSquareRootOfWhatIsNotPositiveIsZero) {
  EXPECT_EQ(sqrt(DoubleDouble(0.0)).hi, 0.0);
  EXPECT_EQ(sqrt(DoubleDouble(-1.0)).hi, 0.0);
  EXPECT_EQ(sqrt(DoubleDouble(std::nan(""))).hi, 0.0);
}

TEST(DoubleDouble, SumAndProductOfDoublesAreExact) {
  Rng rng(seed);
  for (int i = 0; i < 20000; ++i) {
    const double a = random_value(rng).hi;
    const double b = a * families::uniform(rng, -2.0, 2.0);
    ASSERT_TRUE(real(DoubleDouble::sum(a, b)) == Real(a) + Real(b)) << "seed " << seed;
    ASSERT_TRUE(real(DoubleDouble::product(a, b)) == Real(a) * Real(b)) << "seed " << seed;
  }
}

TEST(DoubleDouble, TheLowPartIsAtMostHalfAnUlpOfTheHighPart) {
  for_pairs([](DoubleDouble a, DoubleDouble b) {
    for (const DoubleDouble r : {a + b, a - b, a * b, a / b}) EXPECT_EQ(r.hi + r.lo, r.hi);
  });
}

TEST(DoubleDouble, OrderIsThatOfTheExactValues) {
  int decided_by_low_part = 0;
  for_pairs([&](DoubleDouble a, DoubleDouble b) {
    EXPECT_EQ(a < b, real(a) < real(b));
    EXPECT_EQ(a > b, real(a) > real(b));
    EXPECT_EQ(a <= b, real(a) <= real(b));
    EXPECT_EQ(a >= b, real(a) >= real(b));
    EXPECT_TRUE(a <= a && a >= a && !(a < a) && !(a > a));
    decided_by_low_part += a.hi == b.hi ? 1 : 0;
  });
  EXPECT_GT(decided_by_low_part, 1000);
}

TEST(DoubleDouble, KeepsWhatADoubleDrops) {
  EXPECT_EQ(static_cast<double>((DoubleDouble(1.0) + DoubleDouble(1e-30)) - DoubleDouble(1.0)),
            1e-30);
}

}  // namespace double_double_test
}  // namespace repel
