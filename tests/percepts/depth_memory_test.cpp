// SPDX-License-Identifier: BSD-3-Clause
#include <repel/percepts/depth_memory.hpp>

#include <gtest/gtest.h>

#include <vector>

namespace repel::percepts {
namespace depth_memory_test {

constexpr DepthCamera small{.width = 3, .height = 1};
constexpr DepthCamera row{.width = 5, .height = 1};

TEST(DepthMemory, RemembersForAWhileWhatIsNotMeasuredAndWhatTheRobotHidesUntilItIsSeenAgain) {
  DepthMemory memory(small, 2.0);
  std::vector<float> image{1.0F, 1.5F, 0.0F};
  EXPECT_EQ(memory.fill(image, 0.0), 0);
  image = {0.0F, -0.5F, 0.0F};  // nothing measured; the robot; never seen
  EXPECT_EQ(memory.fill(image, 1.0), 2);
  EXPECT_EQ(image, (std::vector<float>{1.0F, 1.5F, 0.0F}));
  image = {0.0F, -0.5F, 0.0F};
  EXPECT_EQ(memory.fill(image, 100.0), 1);
  EXPECT_EQ(image, (std::vector<float>{0.0F, 1.5F, 0.0F})) << "the robot still stands there";
  image = {0.0F, 0.0F, 0.0F};
  EXPECT_EQ(memory.fill(image, 101.0), 1) << "it has gone, and nothing is measured yet";
  image = {0.0F, 2.0F, 0.0F};
  EXPECT_EQ(memory.fill(image, 101.1), 0);
  EXPECT_EQ(image[1], 2.0F);
}

// The pixels that a moving thing leaves and that are lost just then showed it where it was.
TEST(DepthMemory, DoesNotKeepWhatHasMovedOn) {
  DepthMemory memory(row);
  std::vector<float> image{1.0F, 1.0F, 1.0F, 2.0F, 2.0F};
  memory.fill(image, 0.0);
  image = {2.0F, 0.0F, 2.0F, 0.0F, 2.0F};
  EXPECT_EQ(memory.fill(image, 0.1), 1);
  EXPECT_EQ(image, (std::vector<float>{2.0F, 0.0F, 2.0F, 2.0F, 2.0F}));
}

TEST(DepthMemory, ForgetsWhenTold) {
  DepthMemory memory(small);
  std::vector<float> image{1.0F, 1.0F, 1.0F};
  memory.fill(image, 0.0);
  memory.forget();
  image = {0.0F, -1.0F, 0.0F};
  EXPECT_EQ(memory.fill(image, 0.1), 0);
  EXPECT_EQ(image, (std::vector<float>{0.0F, 0.0F, 0.0F}));
  EXPECT_THROW(DepthMemory(small, -1.0), SetupError);
}

}  // namespace depth_memory_test
}  // namespace repel::percepts
