// SPDX-License-Identifier: BSD-3-Clause
#include <repel/percepts/own_body.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include <repel/base/vec.hpp>

namespace repel::percepts {
namespace {

/// The columns or rows of an image in which a ball can be seen.
struct Stretch {
  int first = 0;
  int end = 0;  ///< behind the last

  /// @param at,z [m] centre of the ball across the image and along the optical axis @param focal
  /// [px] @param middle [px] @param size [px] of the image
  static Stretch of_ball(double at, double z, double radius, double focal, double middle,
                         int size) noexcept {
    if (z - radius <= 1e-3) return {0, size};  // beside or around the camera
    // What is nearer spreads wider.
    const double low = (at - radius) / (at < radius ? z - radius : z + radius);
    const double high = (at + radius) / (at > -radius ? z - radius : z + radius);
    const auto clamped = [&](double pixel) {
      return static_cast<int>(std::clamp(pixel, 0.0, static_cast<double>(size)));
    };
    return {clamped(std::floor(middle + focal * low)),
            clamped(std::ceil(middle + focal * high) + 1)};
  }
};

}  // namespace

OwnBody::OwnBody(const DepthCamera& camera, std::vector<Shape> shapes, double margin)
    : camera_(checked(camera)),
      shapes_(std::move(shapes)),
      margin_(repel::checked("margin of the own body", margin, 0.0, 1.0, "m")) {}

int OwnBody::remove(std::span<const Pose> X_CP, std::span<float> depth) const noexcept {
  if (depth.size() < camera_.pixels()) return 0;
  int removed = 0;
  for (std::size_t i = 0; i < std::min(shapes_.size(), X_CP.size()); ++i) {
    if (is_finite(X_CP[i])) removed += remove(shapes_[i], X_CP[i], depth);
  }
  return removed;
}

int OwnBody::remove(const Shape& shape, const Pose& X_CP, std::span<float> depth) const noexcept {
  const double grown = margin_ + shape.level(0).depth;
  const double radius = shape.reach() + margin_;
  const Vec3 p = origin(X_CP);
  const Stretch columns =
      Stretch::of_ball(p.x(), p.z(), radius, camera_.fx, camera_.cx, camera_.width);
  const Stretch rows =
      Stretch::of_ball(p.y(), p.z(), radius, camera_.fy, camera_.cy, camera_.height);
  int removed = 0;
  for (int v = rows.first; v < rows.end; ++v) {
    float* const row = &depth[camera_.at(0, v)];
    for (int u = columns.first; u < columns.end; ++u) {
      if (!camera_.measures(row[u]) || std::abs(row[u] - p.z()) > radius) continue;
      const Vec3 from_part = static_cast<double>(row[u]) * camera_.ray(u, v) - p;
      if (squared_norm(from_part) > radius * radius) continue;
      const bool has_planes = !shape.planes().empty();
      if (has_planes &&
          shape.planes().nearest(rotate_transposed(X_CP, Vec<double>(from_part))).depth < -grown) {
        continue;
      }
      row[u] = -row[u];
      ++removed;
    }
  }
  return removed;
}

}  // namespace repel::percepts
