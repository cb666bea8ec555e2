// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Search for worst-case pairs of the distance query: random restarts and hill climbing on shapes
/// and poses.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>

#include <accuracy/specimen.hpp>
#include <repel/reduction/shape.hpp>
#include <support/gaps.hpp>

namespace repel::accuracy {

/// A shape given by a few numbers, so that a case can be written down.
struct Recipe {
  const char* kind;  ///< "box", "capsule", "cylinder" or the number of vertices of a hull
  double x, y, z;    ///< [m] half extents; radius and half length are x and z
  unsigned seed;     ///< of the vertices of a hull
};

/// Two shapes, the first at the origin.
struct Duel {
  Recipe a, b;
  double q[4];  ///< attitude of B in A: w, x, y, z
  double p[3];  ///< [m] position of B in A

  [[nodiscard]] Pose X_AB() const {
    Pose X = Pose::Identity();
    X.linear() = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
    X.translation() = Vec3(p[0], p[1], p[2]);
    return X;
  }
  void set(const Mat3& R, const Vec3& t) {
    const Eigen::Quaterniond attitude(R);
    const double numbers[4] = {attitude.w(), attitude.x(), attitude.y(), attitude.z()};
    std::copy(numbers, numbers + 4, q);
    std::copy(t.data(), t.data() + 3, p);
  }
  void print() const {
    std::printf("    {");
    for (const Recipe& r : {a, b}) {
      std::printf("{\"%s\", %.17g, %.17g, %.17g, %u}, ", r.kind, r.x, r.y, r.z, r.seed);
    }
    std::printf("{%.17g, %.17g, %.17g, %.17g}, {%.17g, %.17g, %.17g}},\n", q[0], q[1], q[2], q[3],
                p[0], p[1], p[2]);
  }
};

inline Specimen made(const Recipe& r) {
  const std::string kind = r.kind;
  const double reach = std::hypot(r.x, r.y, r.z);
  const Vec3 half(r.x, r.y, r.z);
  if (kind == "box") return {kind, Shape::box(half), families::box(half).vertices, {}, 0.0, reach};
  if (kind == "capsule") {
    return {kind, Shape::capsule(r.x, r.z), {{0, 0, -r.z}, {0, 0, r.z}}, {}, r.x, r.x + r.z};
  }
  if (kind == "cylinder") {
    return {kind, Shape::cylinder(r.x, r.z), {}, {{r.x, -r.z}, {r.x, r.z}},
            0.0,  std::hypot(r.x, r.z)};
  }
  Rng rng(r.seed);
  auto vertices = families::cloud(rng, std::stoi(kind), 1.0).vertices;
  for (Vec3& v : vertices) v = v.cwiseProduct(half);
  return {kind, Shape::hull(vertices, {.levels = 2}), vertices, {}, 0.0, half.maxCoeff()};
}

inline bool is_hull(const Recipe& r) {
  return r.kind[0] >= '0' && r.kind[0] <= '9';
}

/// Sizes from that of a needle to a metre. Vertices of hulls stay within a factor of 30.
inline Recipe draw(const char* kind, Rng& rng) {
  Recipe r{kind, 1.0, 1.0, 1.0, static_cast<unsigned>(rng() % 100000)};
  const double least = is_hull(r) ? 0.03 : 1e-5;
  for (double* size : {&r.x, &r.y, &r.z}) {
    if (rng() % 2 == 0) *size = families::log_uniform(rng, least, 1.0);
  }
  return r;
}

/// Moves B to a gap of 1e-9 to 1 m, or occasionally into overlap.
inline void set_gap(Duel& duel, const Specimen& A, const Specimen& B, Rng& rng) {
  const Pose X_AB = duel.X_AB();
  const Separation s = separation(A.shape, Pose::Identity(), B.shape, X_AB);
  const double gap = rng() % 8 == 0 ? -families::log_uniform(rng, 1e-9, 0.1)
                                    : families::log_uniform(rng, 1e-9, 1.0);
  duel.set(X_AB.linear(), X_AB.translation() + (s.distance - gap) * s.extraction_W);
}

/// Cost of one answer, from a cold start or warm from a pose 0.5 mm and 0.1 degree away.
inline Separation solve(const Duel& duel, const Specimen& A, const Specimen& B, bool warm) {
  const Pose X_AB = duel.X_AB();
  WarmStart start;
  if (warm) {
    Rng rng(1);
    const Pose nearby = families::moved_a_little(Pose::Identity(), rng);
    const Separation before = separation(A.shape, nearby, B.shape, X_AB, {}, start);
    if (before.end == QueryEnd::bad_input) return before;
  }
  return separation(A.shape, Pose::Identity(), B.shape, X_AB, {}, start);
}

/// Hill climbing for `tries` answers from a random start; stores the most expensive pair in
/// `worst`.
inline void climb(const char* kind_a, const char* kind_b, bool warm, int tries, Rng& rng,
                  Duel& worst, int& most) {
  Duel here{draw(kind_a, rng), draw(kind_b, rng), {}, {}};
  here.set(rng() % 2 == 0 ? families::rotation(rng) : Mat3::Identity(),
           3.0 * families::direction(rng));
  Specimen A = made(here.a);
  Specimen B = made(here.b);
  set_gap(here, A, B, rng);
  int cost = solve(here, A, B, warm).iterations;
  for (int i = 0; i < tries; ++i) {
    Duel next = here;
    const Pose X_AB = here.X_AB();
    const double step = families::log_uniform(rng, 1e-12, 1.0);
    next.set(
        X_AB.linear() * families::small_rotation(rng, step),
        X_AB.translation() + families::log_uniform(rng, 1e-12, 1.0) * families::direction(rng));
    const bool resized = rng() % 4 == 0 && !is_hull(here.a);
    if (resized) next.a.x *= std::exp(families::uniform(rng, -0.3, 0.3));
    Specimen resized_A = resized ? made(next.a) : A;
    if (rng() % 2 == 0) set_gap(next, resized_A, B, rng);
    const int next_cost = solve(next, resized_A, B, warm).iterations;
    if (next_cost < cost) continue;
    cost = next_cost;
    here = next;
    A = std::move(resized_A);
  }
  if (cost > most) {
    most = cost;
    worst = here;
  }
}

}  // namespace repel::accuracy
