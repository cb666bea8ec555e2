// SPDX-License-Identifier: BSD-3-Clause
#include <repel/percepts/simulated_camera.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <repel/base/vec.hpp>

namespace repel::percepts {

SimulatedCamera::SimulatedCamera(const DepthCamera& camera, std::vector<TriangleMesh> meshes,
                                 const CameraFaults& faults)
    : camera_(checked(camera)), meshes_(std::move(meshes)), faults_(faults), random_(faults.seed) {
  repel::checked("noise of the camera", faults.noise, 0.0, 1.0, "m");
  repel::checked("share of lost pixels", faults.lost, 0.0, 1.0, "");
}

void SimulatedCamera::take(std::span<const Pose> X_CM, std::span<float> depth) noexcept {
  if (depth.size() < camera_.pixels()) return;
  depth = depth.first(camera_.pixels());
  // Inverse depths: that of a plane is linear in the image.
  std::fill(depth.begin(), depth.end(), 0.0F);
  for (std::size_t i = 0; i < std::min(meshes_.size(), X_CM.size()); ++i) {
    if (!is_finite(X_CM[i])) continue;
    for (std::size_t k = 0; k < meshes_[i].triangles.size(); ++k) {
      std::array<Vec3, 3> corners = meshes_[i].corners(k);
      for (Vec3& p : corners) p = X_CM[i] * p;
      draw(before_camera(corners), depth);
    }
  }
  for (float& pixel : depth) {
    const float z = pixel > 0.0F ? 1.0F / pixel : 0.0F;
    pixel = camera_.measures(z) ? z : 0.0F;
  }
  if (faults_.noise > 0.0 || faults_.lost > 0.0) spoil(depth);
}

/// What of a triangle is farther than half the nearest depth (Sutherland and Hodgman, 1974).
SimulatedCamera::Polygon SimulatedCamera::before_camera(
    const std::array<Vec3, 3>& triangle) const noexcept {
  const double least = 0.5 * camera_.nearest;
  Polygon polygon;
  const auto add = [&](const Vec3& p) {
    polygon.corners[static_cast<std::size_t>(polygon.count++)] = p;
  };
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3& p = triangle[i];
    const Vec3& q = triangle[(i + 1) % 3];
    if (p.z() > least) add(p);
    if ((p.z() > least) != (q.z() > least)) add(p + (least - p.z()) / (q.z() - p.z()) * (q - p));
  }
  return polygon;
}

void SimulatedCamera::draw(const Polygon& polygon, std::span<float> inverse) const noexcept {
  if (polygon.count < 3) return;
  const auto& p = polygon.corners;
  const Vec3 n = (p[1] - p[0]).cross(p[2] - p[0]);
  const double offset = n.dot(p[0]);
  if (offset * offset <= 1e-24 * n.squaredNorm()) return;  // seen edge-on
  std::array<std::array<double, 2>, 4> at{};               // [px]
  double top = std::numeric_limits<double>::infinity();
  double bottom = -top;
  for (int i = 0; i < polygon.count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    at[k] = {camera_.fx * p[k].x() / p[k].z() + camera_.cx,
             camera_.fy * p[k].y() / p[k].z() + camera_.cy};
    top = std::min(top, at[k][1]);
    bottom = std::max(bottom, at[k][1]);
  }
  const int first = static_cast<int>(std::ceil(std::max(top, 0.0)));
  const int last = static_cast<int>(std::floor(std::min(bottom, camera_.height - 1.0)));
  for (int v = first; v <= last; ++v) {
    double left = std::numeric_limits<double>::infinity();
    double right = -left;
    for (int i = 0; i < polygon.count; ++i) {
      const auto& a = at[static_cast<std::size_t>(i)];
      const auto& b = at[static_cast<std::size_t>((i + 1) % polygon.count)];
      if ((a[1] < v && b[1] < v) || (a[1] > v && b[1] > v)) continue;
      const double along = a[1] == b[1] ? 0.0 : (v - a[1]) / (b[1] - a[1]);
      for (const double u :
           {a[0] + along * (b[0] - a[0]), a[1] == b[1] ? b[0] : a[0] + along * (b[0] - a[0])}) {
        left = std::min(left, u);
        right = std::max(right, u);
      }
    }
    const int from = static_cast<int>(std::ceil(std::max(left, 0.0)));
    const int to = static_cast<int>(std::floor(std::min(right, camera_.width - 1.0)));
    for (int u = from; u <= to; ++u) {
      float& pixel = inverse[camera_.at(u, v)];
      pixel = std::max(pixel, static_cast<float>(n.dot(camera_.ray(u, v)) / offset));
    }
  }
}

void SimulatedCamera::spoil(std::span<float> depth) noexcept {
  std::uniform_real_distribution<double> chance(0.0, 1.0);
  for (float& z : depth) {
    const bool is_lost = faults_.lost > 0.0 && chance(random_) < faults_.lost;
    const double error = faults_.noise > 0.0 ? faults_.noise * noise_(random_) : 0.0;
    z = is_lost || z == 0.0F ? 0.0F : z + static_cast<float>(error * z * z);
  }
}

}  // namespace repel::percepts
