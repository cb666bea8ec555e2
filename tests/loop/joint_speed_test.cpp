// SPDX-License-Identifier: BSD-3-Clause
#include <repel/loop/joint_speed.hpp>

#include <gtest/gtest.h>

#include "loop/slider.hpp"
#include "support/families.hpp"

namespace repel {
namespace joint_speed_test {

constexpr unsigned seed = 277;

TEST(JointSpeed, FadesWhatDrivesOverTheLastFifthAndNothingElse) {
  EXPECT_EQ(within_speed(10.0, 0.79, 1.0), 10.0);
  EXPECT_NEAR(within_speed(10.0, 0.9, 1.0), 5.0, 1e-12);
  EXPECT_NEAR(within_speed(-10.0, -0.9, 1.0), -5.0, 1e-12);
  EXPECT_EQ(within_speed(10.0, 1.0, 1.0), 0.0);
  EXPECT_EQ(within_speed(10.0, 2.0, 1.0), 0.0);
  EXPECT_EQ(within_speed(-10.0, 2.0, 1.0), -10.0) << "it brakes";
  EXPECT_EQ(within_speed(10.0, 100.0, 0.0), 10.0) << "no limit is known";
}

TEST(JointSpeed, NeverGivesPowerThatWasNotAskedFor) {
  families::Rng rng(seed);
  int faded = 0;
  for (int sample = 0; sample < 10000; ++sample) {
    const double asked = families::uniform(rng, -50.0, 50.0);
    const double v = families::uniform(rng, -2.0, 2.0);
    const double given = within_speed(asked, v, 1.5);
    ASSERT_LE(given * v, asked * v + 1e-12) << "seed " << seed;
    ASSERT_LE(std::abs(given), std::abs(asked));
    faded += given != asked ? 1 : 0;
  }
  EXPECT_GT(faded, 1000);
  EXPECT_LT(faded, 9000);
}

TEST(JointSpeed, IsKeptByAnArmThatIsAskedToGoFasterAndTheStatusSaysSo) {
  test::SliderCell cell(test::push(20.0, 0.25), {.velocity_limit = 0.2, .walls = 0});
  int said = 0;
  for (int tick = 0; tick < 1000; ++tick) {
    const TickRecord& record = cell.tick();
    ASSERT_LT(cell.arm.v[0], 0.2) << "tick " << tick;
    said += (record.status & status::speed_limit) != 0U ? 1 : 0;
    ASSERT_EQ(record.gain, 1.0);
  }
  EXPECT_GT(said, 500);
  EXPECT_GT(cell.arm.v[0], 0.16) << "it must be asked to go on";
}

}  // namespace joint_speed_test
}  // namespace repel
