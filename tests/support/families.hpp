// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Seeded families of pairs of polytopes that are difficult for distance algorithms, and common
/// code of all randomized tests.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include <repel/base/types.hpp>

namespace repel::families {

using Rng = std::mt19937_64;

struct Solid {
  std::vector<Vec3> vertices;  ///< [m]
  bool box = false;
  Vec3 half_extents = Vec3::Zero();  ///< [m] of a box
};

struct Pair {
  Solid A, B;
  Pose X_WA = Pose::Identity(), X_WB = Pose::Identity();
};

inline double uniform(Rng& rng, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(rng);
}
inline double log_uniform(Rng& rng, double low, double high) {
  return std::exp(uniform(rng, std::log(low), std::log(high)));
}
/// Describes the draw in failure messages.
inline std::string of_seed(std::uint64_t seed, const char* what, int i) {
  return "seed " + std::to_string(seed) + ", " + what + " " + std::to_string(i);
}
inline Vec3 direction(Rng& rng) {
  std::normal_distribution<double> normal;
  return Vec3(normal(rng), normal(rng), normal(rng)).normalized();
}
inline Mat3 rotation(Rng& rng) {
  std::normal_distribution<double> normal;
  return Eigen::Quaterniond(normal(rng), normal(rng), normal(rng), normal(rng))
      .normalized()
      .toRotationMatrix();
}
inline Mat3 small_rotation(Rng& rng, double angle) {
  return Eigen::AngleAxisd(angle, direction(rng)).toRotationMatrix();
}
/// A random orientation, with the origin `low` to `high` [m] away.
inline Pose random_pose(Rng& rng, double low, double high) {
  Pose X = Pose::Identity();
  X.linear() = rotation(rng);
  X.translation() = uniform(rng, low, high) * direction(rng);
  return X;
}

inline Solid box(const Vec3& h) {
  Solid s{{}, true, h};
  for (int i = 0; i < 8; ++i) {
    s.vertices.emplace_back((i & 1) != 0 ? h.x() : -h.x(), (i & 2) != 0 ? h.y() : -h.y(),
                            (i & 4) != 0 ? h.z() : -h.z());
  }
  return s;
}
inline Solid random_box(Rng& rng, double low, double high) {
  return box(
      {log_uniform(rng, low, high), log_uniform(rng, low, high), log_uniform(rng, low, high)});
}
inline Solid cloud(Rng& rng, int count, double size) {
  Solid s;
  for (int i = 0; i < count; ++i) s.vertices.push_back(size * direction(rng));
  return s;
}
inline Solid prism(int sides, double radius, double half_length) {
  Solid s;
  for (int i = 0; i < sides; ++i) {
    const double angle = 2.0 * M_PI * i / sides;
    for (double z : {-half_length, half_length}) {
      s.vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
    }
  }
  return s;
}

inline const std::vector<std::string>& names() {
  static const std::vector<std::string> all{
      "random boxes",   "random hulls",    "parallel faces",   "nearly parallel faces",
      "parallel edges", "crossed edges",   "needles",          "plates",
      "ten km away",    "scales 1e-3:1e3", "vertex on vertex", "prisms",
      "mixed"};
  return all;
}

inline int count_between(Rng& rng, int low, int high) {
  return std::uniform_int_distribution<int>(low, high)(rng);
}

/// The shapes of a pair of the family.
inline Pair draw_shapes(const std::string& family, Rng& rng) {
  Pair p;
  p.A = random_box(rng, 0.1, 1.0);
  p.B = random_box(rng, 0.1, 1.0);
  if (family == "random hulls") {
    p.A = cloud(rng, count_between(rng, 4, 16), uniform(rng, 0.3, 1.0));
    p.B = cloud(rng, count_between(rng, 4, 16), uniform(rng, 0.3, 1.0));
  } else if (family == "crossed edges") {
    p.A = box({0.01, 0.01, uniform(rng, 0.5, 2)});
    p.B = box({0.01, 0.01, uniform(rng, 0.5, 2)});
  } else if (family == "needles") {
    p.A = box({log_uniform(rng, 1e-6, 1e-3), log_uniform(rng, 1e-6, 1e-3), 1.0});
    if (count_between(rng, 0, 1) == 0) p.B = box({1.0, log_uniform(rng, 1e-6, 1e-3), 1e-6});
  } else if (family == "plates") {
    p.A = box({1.0, 1.0, log_uniform(rng, 1e-6, 1e-3)});
    if (count_between(rng, 0, 1) == 0) p.B = box({log_uniform(rng, 1e-6, 1e-3), 1.0, 1.0});
  } else if (family == "scales 1e-3:1e3") {
    p.A = random_box(rng, 1e-3, 2e-3);
    p.B = random_box(rng, 3e2, 1e3);
  } else if (family == "prisms") {
    p.A = prism(count_between(rng, 3, 9), uniform(rng, 0.2, 1), uniform(rng, 0.01, 1));
    p.B = prism(count_between(rng, 3, 9), uniform(rng, 0.2, 1), uniform(rng, 0.01, 1));
  } else if (family == "mixed") {
    p.A = cloud(rng, count_between(rng, 1, 6), log_uniform(rng, 1e-2, 10));
    p.B = random_box(rng, 1e-2, 10);
  }
  return p;
}

/// The vertex of `s` farthest along `n` from the origin, when rotated by `R`.
inline Vec3 top(const Solid& s, const Mat3& R, const Vec3& n) {
  Vec3 best = R * s.vertices[0];
  for (const Vec3& v : s.vertices) {
    if (n.dot(R * v) > n.dot(best)) best = R * v;
  }
  return best;
}

/// Poses of the family for its shapes, the centres some way apart; they may overlap.
inline void draw_poses(const std::string& family, Pair& p, Rng& rng) {
  p.X_WA = p.X_WB = Pose::Identity();
  const Mat3 R = rotation(rng);
  p.X_WA.linear() = R;
  p.X_WB.linear() = rotation(rng);
  p.X_WB.translation() = uniform(rng, 1.0, 4.0) * direction(rng);
  if (family == "parallel faces" || (family == "prisms" && count_between(rng, 0, 1) == 0)) {
    p.X_WB.linear() = R;
  } else if (family == "nearly parallel faces") {
    p.X_WB.linear() = R * small_rotation(rng, log_uniform(rng, 1e-15, 1e-3));
  } else if (family == "parallel edges") {
    p.X_WB.linear() = R * Eigen::AngleAxisd(uniform(rng, 0, 3), Vec3::UnitZ());
    const Vec3 across = R * Vec3(uniform(rng, -1, 1), uniform(rng, -1, 1), 0.05).normalized();
    p.X_WB.translation() = uniform(rng, 1.0, 4.0) * across;
  } else if (family == "ten km away") {
    const Vec3 far = 1e4 * direction(rng);
    p.X_WA.translation() += far;
    p.X_WB.translation() += far;
  } else if (family == "scales 1e-3:1e3") {
    p.X_WB.translation() = uniform(rng, 500, 2000) * direction(rng);
  } else if (family == "vertex on vertex") {
    const Vec3 n = direction(rng);
    p.X_WB.translation() = top(p.A, R, n) - top(p.B, p.X_WB.linear(), -n) + 0.1 * n;
  } else if (family == "mixed") {
    p.X_WB.translation() = uniform(rng, 1, 20) * direction(rng);
  }
}

/// A seeded pair of the family; it may overlap.
inline Pair draw(const std::string& family, Rng& rng) {
  Pair p = draw_shapes(family, rng);
  draw_poses(family, p, rng);
  return p;
}

}  // namespace repel::families
