// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// One cell of the accuracy table: many poses of one pair of kinds at one gap.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <accuracy/specimen.hpp>

namespace repel::accuracy {

/// Measured values; lengths are relative to the larger size of the two shapes.
struct Cell {
  double absolute = 0.0;       ///< worst error
  double relative = 0.0;       ///< worst error relative to the distance
  double width = 0.0;          ///< widest bracket
  double least_share = 1e300;  ///< in overlap: least ratio of the answer to the depth
  int misses = 0;  ///< answers with a wrong sign, or a bracket that excludes the exact value
  std::vector<int> iterations;
  std::vector<double> shares;

  [[nodiscard]] int most_iterations() const {
    return *std::max_element(iterations.begin(), iterations.end());
  }
};

template <class T>
T median(std::vector<T> values) {
  std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
  return values[values.size() / 2];
}

/// Random orientations; or the axes of one parallel, or nearly so, to those of the other.
inline void turn(Pose& X_WA, Pose& X_WB, int attitude, Rng& rng) {
  X_WA.linear() = families::rotation(rng);
  X_WB.linear() = families::rotation(rng);
  if (attitude % 3 == 0) return;
  const Vec3 axis = Vec3::Unit(attitude % 2 == 0 ? 0 : 1);
  const Mat3 quarter = Eigen::AngleAxisd(attitude % 4 * M_PI / 2, axis).toRotationMatrix();
  X_WB.linear() = X_WA.linear() * quarter;
  if (attitude % 3 == 2) {
    X_WB.linear() *= families::small_rotation(rng, families::log_uniform(rng, 1e-12, 1e-3));
  }
}

/// Adds a pose of A and B at `gap` [m].
inline void add_apart(Cell& cell, const Specimen& A, const Specimen& B, double gap, Rng& rng) {
  Pose X_WA = Pose::Identity();
  Pose X_WB = Pose::Identity();
  turn(X_WA, X_WB, static_cast<int>(cell.iterations.size()), rng);
  X_WB.translation() = 2.1 * (A.size + B.size) * families::direction(rng);
  const oracle::Bracket far = PosedPair(A, X_WA, B, X_WB).distance();
  Vec3 n;
  for (int i = 0; i < 3; ++i) n[i] = static_cast<double>(far.nearest.x[i]);
  X_WB.translation() += (static_cast<double>(far.upper) - gap) * n.normalized();
  const oracle::Bracket truth = PosedPair(A, X_WA, B, X_WB).distance();
  const Separation s = separation(A.shape, X_WA, B.shape, X_WB);
  const Real off = std::max(oracle::magnitude(Real(s.distance) - truth.lower),
                            oracle::magnitude(Real(s.distance) - truth.upper));
  const double size = std::max(A.size, B.size);
  cell.absolute = std::max(cell.absolute, static_cast<double>(off) / size);
  cell.relative = std::max(cell.relative, static_cast<double>(off / truth.lower));
  cell.width = std::max(cell.width, (s.upper - s.lower) / size);
  cell.misses += Real(s.lower) > truth.upper || Real(s.upper) < truth.lower || !(s.distance > 0.0);
  cell.iterations.push_back(s.iterations);
}

/// Adds a pose with the centres closer than half the smaller size, its overlap by `measure`.
inline void add_overlapping(Cell& cell, const Specimen& A, const Specimen& B, Measure measure,
                            Rng& rng) {
  Pose X_WA = Pose::Identity();
  Pose X_WB = Pose::Identity();
  turn(X_WA, X_WB, static_cast<int>(cell.iterations.size()), rng);
  const double smaller = std::min(A.size, B.size);
  X_WB.translation() = families::uniform(rng, 0.0, 0.5) * smaller * families::direction(rng);
  const PosedPair pair(A, X_WA, B, X_WB);
  const Separation s = separation(A.shape, X_WA, B.shape, X_WB, {.measure = measure});
  const double depth = pair.depth_by_search(s.extraction_W, rng);
  if (depth <= 0.0) return;  // rare: a thin hull beside the other
  const double size = std::max(A.size, B.size);
  cell.width = std::max(cell.width, (s.upper - s.lower) / size);
  cell.shares.push_back(-s.distance / depth);
  cell.least_share = std::min(cell.least_share, cell.shares.back());
  cell.misses += s.lower > -depth + 1e-13 * size || s.upper < -depth - 1e-13 * size ||
                 s.distance > 0.0 || s.distance < -depth - 1e-13 * size;
  cell.iterations.push_back(s.iterations);
}

}  // namespace repel::accuracy
