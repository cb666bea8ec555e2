// SPDX-License-Identifier: BSD-3-Clause
#include <repel/percepts/simulated_camera.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include <repel/reduction/shape_mesh.hpp>

#include "percepts/seen.hpp"

namespace repel::percepts {
namespace simulated_camera_test {

constexpr DepthCamera camera{};

std::vector<float> image_of(SimulatedCamera& taken, const std::vector<Pose>& X_CM) {
  std::vector<float> image(camera.pixels());
  taken.take(X_CM, image);
  return image;
}

/// A rectangle that fills the image, inclined: n.p = offset.
TriangleMesh sheet(const test::Plane& plane) {
  TriangleMesh mesh;
  for (const double x : {-9.0, 9.0}) {
    for (const double y : {-9.0, 9.0}) {
      mesh.vertices.emplace_back(x, y,
                                 (plane.offset - plane.n.x() * x - plane.n.y() * y) / plane.n.z());
    }
  }
  mesh.triangles = {{0, 1, 2}, {1, 2, 3}};
  return mesh;
}

TEST(SimulatedCamera, SeesWhatAFormulaSaysOfBallsBeforeAWall) {
  const test::Ball ball{{0.1, -0.05, 0.8}, 0.1};
  const test::Plane wall{{0.2, 0.1, 1.0}, 2.0};
  SimulatedCamera taken(camera, {mesh_of(Shape::sphere(ball.radius)), sheet(wall)});
  const auto image = image_of(taken, {Pose(Eigen::Translation3d(ball.centre)), Pose::Identity()});
  const auto truth = test::depths(camera, {ball}, {wall});
  int of_rim = 0;
  int of_ball = 0;
  for (std::size_t i = 0; i < image.size(); ++i) {
    const Vec3 ray = camera.ray(static_cast<int>(i) % 320, static_cast<int>(i) / 320);
    const bool is_ball = truth[i] < 1.0F;
    of_ball += is_ball ? 1 : 0;
    if (!is_ball) {
      ASSERT_NEAR(image[i], truth[i], 1e-5) << "the wall, pixel " << i;
    }
    // The ball is drawn by chords: up to 1 mm smaller, more along a ray that grazes it.
    if (std::abs(image[i] - truth[i]) * ray.norm() > 2e-3) of_rim += 1;
  }
  EXPECT_LT(of_rim, of_ball / 6);
  EXPECT_GT(of_ball, 3000);
}

TEST(SimulatedCamera, CutsWhatReachesBehindItAndLeavesOutWhatIsNotThere) {
  // A floor under the camera, from behind it to far before it.
  TriangleMesh floor;
  floor.vertices = {{-9, 1, -9}, {9, 1, -9}, {-9, 1, 9}, {9, 1, 9}};
  floor.triangles = {{0, 1, 2}, {2, 1, 3}};
  SimulatedCamera taken(camera, {floor});
  const auto image = image_of(taken, {Pose::Identity()});
  for (int v = 0; v < camera.height; ++v) {
    const double z = camera.ray(0, v).y() > 0.0 ? 1.0 / camera.ray(0, v).y() : 0.0;
    const bool is_seen = z > 0.0 && z <= camera.farthest;
    ASSERT_NEAR(image[camera.at(160, v)], is_seen ? z : 0.0, 1e-4) << "row " << v;
  }
  Pose nowhere = Pose::Identity();
  nowhere.translation().x() = std::numeric_limits<double>::quiet_NaN();
  for (const float z : image_of(taken, {nowhere})) ASSERT_EQ(z, 0.0F);
}

TEST(SimulatedCamera, HasTheFaultsItIsAskedForAndRepeatsThem) {
  const test::Plane wall{{0, 0, 1}, 2.0};
  const CameraFaults faults{.noise = 1e-3, .lost = 0.1, .seed = 7};
  SimulatedCamera first(camera, {sheet(wall)}, faults);
  SimulatedCamera second(camera, {sheet(wall)}, faults);
  const auto image = image_of(first, {Pose::Identity()});
  EXPECT_EQ(image, image_of(second, {Pose::Identity()}));
  double sum = 0.0;
  int lost = 0;
  for (const float z : image) {
    lost += z == 0.0F ? 1 : 0;
    if (z > 0.0F) sum += (z - 2.0) * (z - 2.0);
  }
  const double pixels = static_cast<double>(camera.pixels());
  EXPECT_NEAR(lost / pixels, 0.1, 0.01);
  EXPECT_NEAR(std::sqrt(sum / (pixels - lost)), 4e-3, 2e-4) << "1 mm at 1 m, 4 mm at 2 m";
  EXPECT_THROW(SimulatedCamera(camera, {}, {.noise = -1.0}), SetupError);
}

}  // namespace simulated_camera_test
}  // namespace repel::percepts
