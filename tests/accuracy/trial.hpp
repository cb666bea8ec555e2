// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// One pair of posed polytopes, its exact answer, and all invariants that an answer must satisfy.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <accuracy/tally.hpp>
#include <repel/reduction/separation.hpp>
#include <repel/reduction/shape.hpp>
#include <support/exact_depth.hpp>
#include <support/gaps.hpp>

namespace repel::accuracy {

using families::Rng;
using families::Solid;
using oracle::Real;

/// A polytope in the types of the library and of the oracle.
struct Body {
  oracle::Polytope features;
  Shape shape;
  Shape repeated;  ///< the same with shuffled vertices, every other one duplicated
  double size;     ///< [m]

  // Two levels of reduction: they affect the measured depth of an overlap, not its bounds.
  Body(const Solid& s, Rng& rng)
      : features(s.vertices),
        shape(s.box ? Shape::box(s.half_extents) : Shape::hull(s.vertices, {.levels = 2})),
        repeated(Shape::hull(shuffled(s.vertices, rng), {.levels = 1})),
        size(features.reach()) {}

 private:
  static std::vector<Vec3> shuffled(std::vector<Vec3> vertices, Rng& rng) {
    const std::size_t count = vertices.size();
    for (std::size_t i = 0; i < count; i += 2) vertices.push_back(vertices[i]);
    std::shuffle(vertices.begin(), vertices.end(), rng);
    return vertices;
  }
};

/// Distance of `p_WQ` outside the polytope [m]; not positive inside.
inline double outside_by(const Body& body, const Pose& X_WB, const Vec3& p_WQ) {
  const Vec3 q = X_WB.linear().transpose() * (p_WQ - X_WB.translation());
  if (body.features.closed()) return body.features.outside_by(q);
  const auto truth =
      oracle::distance(body.features.vertices(), Pose::Identity(), {q}, Pose::Identity());
  return truth ? static_cast<double>(truth->distance) : 1e300;
}

class Trial {
 public:
  Trial(const Body& A, const Pose& X_WA, const Body& B, const Pose& X_WB, Tally& tally)
      : A_(A), B_(B), X_WA_(X_WA), X_WB_(X_WB), tally_(tally), size_(std::max(A.size, B.size)) {}

  /// Queries the oracle; false if it has no proven answer.
  bool find_truth(bool expect_overlap) {
    if (expect_overlap && solid()) truth_ = -depth();
    if (!(truth_ < 0)) {
      const auto found = oracle::distance(A_.features, X_WA_, B_.features, X_WB_);
      if (!tally_.ask(Law::oracle, found.has_value())) return false;
      truth_ = found->distance;
      if (!(truth_ > 0) && solid()) truth_ = -depth();
    }
    ++tally_.pairs;
    (truth_ > 0 ? tally_.apart : tally_.overlapping) += 1;
    if (truth_ > 0 && truth_ < Real(1e-6)) ++tally_.below_micrometre;
    return true;
  }

  /// Invariants of every answer, cold and warm from a pose 0.5 mm and 0.1 degree away.
  void ask_cold_and_warm(Rng& rng) {
    cold_ = separation(A_.shape, X_WA_, B_.shape, X_WB_);
    check(cold_);
    WarmStart warm;
    const Pose nearby = families::moved_a_little(X_WA_, rng);
    check_sound(separation(A_.shape, nearby, B_.shape, X_WB_, {}, warm));
    check(separation(A_.shape, X_WA_, B_.shape, X_WB_, {}, warm));
    if (truth_ > 0 && in_extended_precision()) ++tally_.extended;
  }

  /// Arguments swapped, both moved together, and shapes with shuffled and duplicated vertices.
  void ask_invariances(Rng& rng) {
    const Separation swapped = separation(B_.shape, X_WB_, A_.shape, X_WA_);
    check_bracket(swapped);
    ask(Law::swapped, same(swapped.distance, rounding()));
    const Separation repeated = separation(A_.repeated, X_WA_, B_.repeated, X_WB_);
    check_bracket(repeated);
    // In overlap, other levels give another depth.
    ask(Law::reordered, truth_ < 0 || same(repeated.distance, rounding()));
    Pose X = Pose::Identity();
    X.linear() = families::rotation(rng);
    X.translation() = families::log_uniform(rng, 1.0, 1e3) * families::direction(rng);
    const Separation moved = separation(A_.shape, X * X_WA_, B_.shape, X * X_WB_);
    // Far from the origin the resolution of a pose is coarser: 1.1e-13 m at 1 km.
    const double step = 1e-14 * (1e3 + X_WA_.translation().norm() + size_);
    ask(Law::moved, same(moved.distance, step));
  }

  [[nodiscard]] bool has_failed() const { return failed_; }
  [[nodiscard]] double truth() const { return static_cast<double>(truth_); }

 private:
  /// With one solid the Minkowski difference is solid, and its facets come from features of both.
  [[nodiscard]] bool solid() const { return A_.features.closed() || B_.features.closed(); }
  [[nodiscard]] Real depth() const {
    return oracle::penetration_depth(A_.features, X_WA_, B_.features, X_WB_);
  }
  [[nodiscard]] double rounding() const {
    return truth_ > 0 ? std::min(4e-14 * size_, 2e-6 * truth()) : 1e-12 * size_;
  }
  [[nodiscard]] bool same(double distance, double tolerance) const {
    return std::abs(distance - cold_.distance) <= tolerance;
  }

  bool ask(Law law, bool held) {
    failed_ = failed_ || !held;
    return tally_.ask(law, held);
  }

  /// How the core reports that it was decided.
  [[nodiscard]] bool in_extended_precision() const {
    WarmStart cold;
    return gap_between(A_.shape.level(0).core, X_WA_, B_.shape.level(0).core, X_WB_, {}, cold)
        .extended;
  }

  void check_sound(const Separation& s) {
    ++tally_.answers;
    tally_.most_iterations = std::max<long>(tally_.most_iterations, s.iterations);
    ask(Law::bracket, s.lower <= s.distance && s.distance <= s.upper);
  }

  void check_bracket(const Separation& s) {
    check_sound(s);
    ask(Law::sign, truth_ > 0 ? s.distance > 0.0 : s.distance <= 0.0);
    ask(Law::bracket, Real(s.lower) <= truth_ && truth_ <= Real(s.upper));
  }

  void check(const Separation& s) {
    check_bracket(s);
    if (truth_ > 0) {
      const double error = std::abs(static_cast<double>(Real(s.distance) - truth_));
      ask(Law::ended, s.end == QueryEnd::converged);
      ask(Law::absolute, error <= 2e-14 * size_);
      ask(Law::relative, error <= 1e-6 * truth());
      tally_.worst_absolute = std::max(tally_.worst_absolute, error / size_);
      tally_.worst_relative = std::max(tally_.worst_relative, error / truth());
    } else {
      const double too_deep = static_cast<double>(truth_ - Real(s.distance));
      ask(Law::depth, too_deep <= 2e-14 * size_);
      const bool deep = -truth() > 1e-9 * size_;
      ask(Law::ended, !deep || s.end == QueryEnd::converged);
    }
    check_witnesses(s);
  }

  void check_witnesses(const Separation& s) {
    const double off =
        std::max(outside_by(A_, X_WA_, s.p_WA) / A_.size, outside_by(B_, X_WB_, s.p_WB) / B_.size);
    ask(Law::on_shapes, off <= 1e-9);
    tally_.worst_on_shape = std::max(tally_.worst_on_shape, off);
    const Vec3 between = s.p_WA - s.p_WB;
    const bool unit = std::abs(s.extraction_W.norm() - 1.0) <= 1e-12;
    const double beside = (between - s.distance * s.extraction_W).norm() / size_;
    if (truth_ > 0) {
      ask(Law::along_normal, unit && beside <= 1e-9);
      tally_.worst_between = std::max(tally_.worst_between, beside);
    } else {
      // If intersecting levels decide, the levels of the witness points are farther apart.
      const double along = between.dot(s.extraction_W);
      ask(Law::along_normal, unit && along >= s.distance - 1e-9 * size_);
    }
  }

  const Body& A_;
  const Body& B_;
  const Pose X_WA_, X_WB_;
  Tally& tally_;
  double size_;
  Real truth_ = 0;
  Separation cold_;
  bool failed_ = false;
};

}  // namespace repel::accuracy
