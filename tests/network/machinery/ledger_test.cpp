// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/machinery/ledger.hpp>

#include <gtest/gtest.h>

#include "support/families.hpp"

namespace repel::network {
namespace ledger_test {

constexpr unsigned seed = 13;

TEST(Ledger, AddsUpWhatWentInAndWhatWasSupplied) {
  Ledger ledger;
  ledger.add(3.0, 5.0, 0.0);
  ledger.add(-1.0, 1.0, 0.5);
  EXPECT_EQ(ledger.energy, 2.5);
  EXPECT_EQ(ledger.supplied, 0.5);
  EXPECT_EQ(ledger.passed, 6.0);
  EXPECT_EQ(ledger.least, 0.0);
  EXPECT_EQ(ledger.deficit(), 0.0);
}

// Energy absorbed later does not compensate an earlier negative balance.
TEST(Ledger, DeficitIsTheLowestEverAsAPartOfWhatPassed) {
  Ledger ledger;
  ledger.add(-2.0, 2.0, 0.0);
  ledger.add(10.0, 10.0, 0.0);
  EXPECT_EQ(ledger.energy, 8.0);
  EXPECT_EQ(ledger.least, -2.0);
  EXPECT_DOUBLE_EQ(ledger.deficit(), 2.0 / 12.0);
}

TEST(Ledger, ModuleThroughWhichNothingPassedHasNoDeficit) {
  EXPECT_EQ(Ledger{}.deficit(), 0.0);
}

// Regression: a junction of a source and a rigid end had a deficit of all the energy passed,
// 4.6e-15 J.
TEST(Ledger, RoundingWhereNextToNothingPassesIsNoDeficit) {
  Ledger ledger;
  ledger.add(-4.6e-15, 4.6e-15, 0.0);
  EXPECT_LT(ledger.deficit(), 1e-11);
  EXPECT_GT(ledger.deficit(), 0.0);
}

TEST(Ledger, SourceThatGivesWhatItWasSuppliedWithIsAtZero) {
  families::Rng rng(seed);
  Ledger ledger;
  for (int i = 0; i < 100000; ++i) {
    const double given = families::uniform(rng, -1.0, 2.0);
    ledger.add(-given, std::abs(given), given);
  }
  EXPECT_EQ(ledger.energy, 0.0) << "seed " << seed;
  EXPECT_GT(ledger.supplied, 40000.0);
  EXPECT_EQ(ledger.deficit(), 0.0);
}

}  // namespace ledger_test
}  // namespace repel::network
