// SPDX-License-Identifier: BSD-3-Clause
// A run that is asked to stop continues until the forces have faded out, and no longer.

#include <gtest/gtest.h>

#include <array>

#include <repel/runs/engine/fade_out.hpp>

namespace repel::runs {
namespace fade_out_test {

/// Two arms whose gains decrease by a given amount per tick once the run is to end; counts the
/// ticks.
struct Bench {
  std::atomic<bool> stop{false};
  std::atomic<bool> at_once{false};
  std::array<TickRecord, 2> arms{};
  std::array<const TickRecord*, 2> last{&arms[0], &arms[1]};

  int ticks_from_stop(double period, double first_falls, double second_falls, int at_once_at = -1) {
    FadeOut fade(stop, &at_once, period);
    EXPECT_FALSE(fade.is_over({}));
    EXPECT_FALSE(fade.is_over(last));
    EXPECT_FALSE(fade.has_begun());
    stop = true;
    int made = 0;
    for (; made < 100000 && !fade.is_over(last); ++made) {
      EXPECT_TRUE(fade.has_begun());
      arms[0].gain = std::max(0.0, arms[0].gain - first_falls);
      arms[1].gain = std::max(0.0, arms[1].gain - second_falls);
      at_once = made + 1 == at_once_at;
    }
    return made;
  }
};

TEST(FadeOut, EndsWhenTheForcesOfAllArmsAreGone) {
  EXPECT_EQ(Bench().ticks_from_stop(0.0025, 0.5, 0.125), 8);
  EXPECT_EQ(Bench().ticks_from_stop(0.0025, 0.125, 0.5), 8);
}

TEST(FadeOut, EndsAfterHalfASecondWhateverTheForcesAreAndAfterOneTickAtLeast) {
  EXPECT_EQ(Bench().ticks_from_stop(1.0 / 512.0, 0.5, 0.0), 256);
  EXPECT_EQ(Bench().ticks_from_stop(1.0, 0.0, 0.0), 1);
}

TEST(FadeOut, EndsAtOnceWhenAskedAgain) {
  EXPECT_EQ(Bench().ticks_from_stop(0.0025, 0.0, 0.0, 3), 3);
}

TEST(FadeOut, RunWithoutATickHasNothingToFade) {
  const std::atomic<bool> stop{true};
  FadeOut fade(stop, nullptr, 0.0025);
  EXPECT_TRUE(fade.is_over({}));
}

TEST(FadeOut, WhatIsFadedAlreadyEndsAtOnce) {
  Bench bench;
  FadeOut fade(bench.stop, nullptr, 0.0025);
  bench.arms[0].gain = bench.arms[1].gain = 0.0;
  EXPECT_FALSE(fade.is_over(bench.last));
  bench.stop = true;
  EXPECT_TRUE(fade.is_over(bench.last));
}

}  // namespace fade_out_test
}  // namespace repel::runs
