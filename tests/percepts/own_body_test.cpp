// SPDX-License-Identifier: BSD-3-Clause
#include <repel/percepts/own_body.hpp>

#include <gtest/gtest.h>

#include "percepts/seen.hpp"

namespace repel::percepts {
namespace own_body_test {

TEST(OwnBody, IsTakenOutAndNothingElse) {
  const DepthCamera camera;
  const Vec3 centre(0.1, -0.05, 0.8);
  const OwnBody own(camera, {Shape::sphere(0.1), Shape::box({0.05, 0.1, 0.2})}, 0.02);
  const std::vector<Pose> X_CP{Pose(Eigen::Translation3d(centre)),
                               Pose(Eigen::Translation3d(5, 5, -1))};
  const auto wall = test::depths(camera, {}, {{{0, 0, 1}, 2.0}});
  const auto before = test::depths(camera, {{centre, 0.1}}, {{{0, 0, 1}, 2.0}});
  auto image = before;
  const int removed = own.remove(X_CP, image);
  int of_ball = 0;
  for (std::size_t i = 0; i < image.size(); ++i) {
    const bool is_ball = before[i] != wall[i];
    of_ball += is_ball ? 1 : 0;
    ASSERT_EQ(image[i], is_ball ? -before[i] : wall[i]) << "pixel " << i;
  }
  EXPECT_EQ(removed, of_ball);
  EXPECT_GT(of_ball, 1000);
}

TEST(OwnBody, IsLargerByItsMargin) {
  const DepthCamera camera;
  const std::vector<Pose> X_CP{Pose(Eigen::Translation3d(0, 0, 1))};
  const auto removed_with = [&](double margin) {
    // What is seen is 15 mm before the part.
    auto image = test::depths(camera, {}, {{{0, 0, 1}, 0.885}});
    return OwnBody(camera, {Shape::box({0.1, 0.1, 0.1})}, margin).remove(X_CP, image);
  };
  EXPECT_EQ(removed_with(0.01), 0);
  EXPECT_GT(removed_with(0.02), 1000);
}

TEST(OwnBody, IsFoundAroundTheCameraToo) {
  const DepthCamera camera;
  auto image = test::depths(camera, {}, {{{0, 0, 1}, 0.2}});
  const OwnBody own(camera, {Shape::box({0.5, 0.5, 0.5})});
  EXPECT_EQ(own.remove(std::vector<Pose>{Pose::Identity()}, image), 320 * 240);
  EXPECT_THROW(OwnBody(camera, {}, 2.0), SetupError);
}

}  // namespace own_body_test
}  // namespace repel::percepts
