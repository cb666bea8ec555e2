// SPDX-License-Identifier: BSD-3-Clause
// The clutch: semantics of the button.
#include <repel/devices/clutch.hpp>

#include <gtest/gtest.h>

namespace repel::devices {
namespace clutch_test {

TEST(Clutch, AlwaysNeedsNoButton) {
  Clutch clutch(ClutchPolicy::always);
  EXPECT_TRUE(clutch.engaged());
  clutch.set(true);
  clutch.set(false);
  clutch.reset();
  EXPECT_TRUE(clutch.engaged());
}

TEST(Clutch, HoldIsEngagedWhileTheButtonIsDown) {
  Clutch clutch(ClutchPolicy::hold);
  EXPECT_FALSE(clutch.engaged());
  clutch.set(true);
  EXPECT_TRUE(clutch.engaged());
  clutch.set(false);
  EXPECT_FALSE(clutch.engaged());
}

TEST(Clutch, ToggleChangesWithEachPressAndNotWithItsRepetition) {
  Clutch clutch(ClutchPolicy::toggle);
  EXPECT_FALSE(clutch.engaged());
  clutch.set(true);
  clutch.set(true);
  EXPECT_TRUE(clutch.engaged());
  clutch.set(false);
  EXPECT_TRUE(clutch.engaged());
  clutch.set(true);
  EXPECT_FALSE(clutch.engaged());
}

TEST(Clutch, ResetReleasesIt) {
  for (const ClutchPolicy policy : {ClutchPolicy::hold, ClutchPolicy::toggle}) {
    Clutch clutch(policy);
    clutch.set(true);
    ASSERT_TRUE(clutch.engaged());
    clutch.reset();
    EXPECT_FALSE(clutch.engaged());
  }
}

}  // namespace clutch_test
}  // namespace repel::devices
