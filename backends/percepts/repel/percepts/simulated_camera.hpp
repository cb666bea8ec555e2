// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A depth camera that is computed: for tests, and to try a cell without one.
#pragma once

#include <array>
#include <cstdint>
#include <random>
#include <span>
#include <vector>

#include <repel/geometry/triangle_mesh.hpp>
#include <repel/percepts/depth_camera.hpp>

namespace repel::percepts {

/// What is wrong with a depth camera.
struct CameraFaults {
  double noise = 0.0;      ///< [m] standard deviation at 1 m, growing with the square of the depth
  double lost = 0.0;       ///< share of the pixels without a depth, 0 to 1
  std::uint64_t seed = 1;  ///< the same seed gives the same faults
};

/// Draws what a depth camera sees of triangle meshes. A pixel shows the nearest triangle that its
/// ray meets, from either side; the same calls give the same images. Allocates at construction
/// only.
class SimulatedCamera {
 public:
  /// @param meshes that can be seen, each in a frame of its own
  /// @throws SetupError for a number out of range
  SimulatedCamera(const DepthCamera& camera, std::vector<TriangleMesh> meshes,
                  const CameraFaults& faults = {});

  /// Takes an image. @param X_CM [m] the frames of the meshes in that of the camera, in their
  /// order; not finite: absent @param depth [m] width x height of the camera, is overwritten; a
  /// shorter one stays as it is. Cost: about 100 ns a triangle and 5 ns a pixel that it covers;
  /// faults 20 ns a pixel
  void take(std::span<const Pose> X_CM, std::span<float> depth) noexcept;

 private:
  /// A convex polygon of at most four corners [m] in the frame of the camera.
  struct Polygon {
    std::array<Vec3, 4> corners;
    int count = 0;
  };

  [[nodiscard]] Polygon before_camera(const std::array<Vec3, 3>& triangle) const noexcept;
  void draw(const Polygon& polygon, std::span<float> inverse) const noexcept;
  void spoil(std::span<float> depth) noexcept;

  DepthCamera camera_;
  std::vector<TriangleMesh> meshes_;
  CameraFaults faults_;
  std::mt19937_64 random_;
  std::normal_distribution<double> noise_{0.0, 1.0};
};

}  // namespace repel::percepts
