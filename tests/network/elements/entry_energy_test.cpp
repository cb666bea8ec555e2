// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/elements/entry_energy.hpp>

#include <gtest/gtest.h>

namespace repel::network {
namespace entry_energy_test {

TEST(EntryEnergy, SpendsWhatIsSpareBeforeItsOwn) {
  EntryEnergy entry(1.0);
  entry.begin(0.3, 0.0);
  EXPECT_DOUBLE_EQ(entry.raised(0.0, 1.0, 0.1, 2.0), 0.1);  // costs 0.2 J
  EXPECT_EQ(entry.spent(), 0.0);
  EXPECT_DOUBLE_EQ(entry.raised(0.1, 1.0, 0.1, 2.0), 0.2);
  EXPECT_NEAR(entry.spent(), 0.1, 1e-15);
  EXPECT_NEAR(entry.left(), 0.9, 1e-15);
}

TEST(EntryEnergy, StopsWhereThereIsNoneAndRefillsSlowly) {
  EntryEnergy entry(0.5);
  entry.begin(-3.0, 0.0);
  EXPECT_DOUBLE_EQ(entry.raised(0.0, 1.0, 1.0, 2.0), 0.25);
  EXPECT_EQ(entry.left(), 0.0);
  entry.begin(0.0, 0.0);
  EXPECT_EQ(entry.raised(0.25, 1.0, 1.0, 2.0), 0.25);
  EXPECT_EQ(entry.raised(0.25, 1.0, 1.0, 0.0), 1.0) << "at the fixture it costs nothing";
  double spent = 0.0;
  for (int tick = 0; tick < 4000; ++tick) {  // 40 s
    entry.begin(0.0, 0.01);
    (void)entry.raised(0.0, 1.0, 1.0, 1e3);
    spent += entry.spent();
  }
  EXPECT_NEAR(spent, 0.5 * 40.0 / EntryEnergy::refill, 1e-9);
  for (int tick = 0; tick < 4000; ++tick) entry.begin(0.0, 0.01);
  EXPECT_DOUBLE_EQ(entry.left(), 0.5);
}

TEST(EntryEnergy, DoesNotLower) {
  EntryEnergy entry(0.5);
  entry.begin(1.0, 0.0);
  EXPECT_EQ(entry.raised(0.7, 0.2, 0.1, 1.0), 0.7);
}

}  // namespace entry_energy_test
}  // namespace repel::network
