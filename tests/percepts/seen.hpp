// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What a camera would see of balls and planes.
#pragma once

#include <cmath>
#include <random>
#include <vector>

#include <repel/percepts/depth_camera.hpp>

namespace repel::percepts::test {

struct Ball {
  Vec3 centre;  // [m] in the frame of the camera
  double radius;
};
/// n.p = offset
struct Plane {
  Vec3 n;
  double offset;  // [m]
};

/// Depths [m] of the nearest of these along each ray; 0 where there is none in the range of the
/// camera.
inline std::vector<float> depths(const DepthCamera& camera, const std::vector<Ball>& balls,
                                 const std::vector<Plane>& planes) {
  std::vector<float> image;
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      const Vec3 ray = camera.ray(u, v);
      double z = 1e9;
      for (const Plane& plane : planes) {
        const double along = plane.n.dot(ray);
        if (plane.offset / along > 0.0) z = std::min(z, plane.offset / along);
      }
      for (const Ball& ball : balls) {
        const double a = ray.squaredNorm();
        const double b = ray.dot(ball.centre);
        const double root = b * b - a * (ball.centre.squaredNorm() - ball.radius * ball.radius);
        if (root > 0.0) z = std::min(z, (b - std::sqrt(root)) / a);
      }
      image.push_back(camera.measures(static_cast<float>(z)) ? static_cast<float>(z) : 0.0F);
    }
  }
  return image;
}

/// Adds noise, and loses a share of the pixels.
inline void spoil(std::vector<float>& image, double noise, double lost, std::mt19937& random) {
  std::normal_distribution<double> error(0.0, noise);
  std::uniform_real_distribution<double> chance(0.0, 1.0);
  for (float& z : image) {
    if (z > 0.0F) z += static_cast<float>(error(random));
    if (chance(random) < lost) z = 0.0F;
  }
}

}  // namespace repel::percepts::test
