// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Lookup table from directions to the candidates for the farthest vertex of a large polytope. The
/// cost of its support map does not grow with the number of vertices.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <repel/base/vec.hpp>

namespace repel {

/// The directions are sorted into the square cells of a cube map around the origin. Each cell lists
/// the vertices that can be the farthest along one of its directions.
///
/// A vertex u is left out of a cell when another one is farther along each of the four corner
/// directions of the cell by more than the rounding error: every direction of the cell is a
/// nonnegative combination of the corners, so u is never the farthest. Hence the first best of
/// `candidates(d)` is exactly the result of a scan of all vertices. That holds also in flat regions
/// and among repeated vertices, or nearly such; there hill climbing along edges gets stuck. A cell
/// containing the normal of a flat face lists all vertices of that face. Coarser cells are kept if
/// refining would exceed `most_candidates` per vertex in total, as at a far corner of a thousand
/// vertices within rounding.
class SupportTable {
 public:
  /// Per vertex, summed over all cells: round shapes have 4 to 8, needles and prisms up to 26.
  static constexpr std::size_t most_candidates = 32;

  SupportTable() = default;
  /// For at least one vertex [m]. Set-up: it allocates. Cost: a few passes over the vertices.
  explicit SupportTable(std::span<const Vec3> vertices);

  /// There are no vertices: made by default.
  [[nodiscard]] bool empty() const noexcept { return first_.empty(); }

  /// [byte] Heap memory held, and its upper bound for a table of so many vertices.
  [[nodiscard]] std::size_t bytes() const noexcept {
    return (first_.capacity() + candidates_.capacity()) * sizeof(std::uint32_t);
  }
  /// [bytes] Upper bound of the heap for the table of so many vertices.
  [[nodiscard]] static std::size_t most_bytes(std::size_t vertices) noexcept {
    const std::size_t width = finest_width(vertices);
    return (6 * width * width + 1 + most_candidates * vertices) * sizeof(std::uint32_t);
  }

  /// Indices, in ascending order, of all candidates for the largest dot product with `d`, as
  /// computed in double or better; of some vertices for a `d` zero or not finite. The table must
  /// not be empty.
  [[nodiscard]] std::span<const std::uint32_t> candidates(const Vec<double>& d) const noexcept {
    return candidates_of(cell_of(d));
  }

 private:
  using List = std::vector<std::uint32_t>;

  // Face 2 k faces the positive axis k, face 2 k + 1 the negative one; the cells of a face are
  // numbered along axis k + 1 first, then along axis k + 2 (mod 3).
  [[nodiscard]] std::size_t cell_of(const Vec<double>& d) const noexcept {
    const double x = std::abs(d.x());
    const double y = std::abs(d.y());
    const double z = std::abs(d.z());
    if (x >= y && x >= z) return cell_at(d.x() > 0.0 ? 0 : 1, d.y() / x, d.z() / x);
    if (y >= z) return cell_at(d.y() > 0.0 ? 2 : 3, d.z() / y, d.x() / y);
    return cell_at(d.z() > 0.0 ? 4 : 5, d.x() / z, d.y() / z);
  }
  [[nodiscard]] std::size_t cell_at(std::size_t face, double u, double v) const noexcept {
    return (face * width_ + step_at(v)) * width_ + step_at(u);
  }
  [[nodiscard]] std::size_t step_at(double u) const noexcept {
    const double width = static_cast<double>(width_);
    const double step = 0.5 * (u + 1.0) * width;
    if (!(step > 0.0)) return 0;  // also when u is NaN
    return step < width ? static_cast<std::size_t>(step) : width_ - 1;
  }

  /// The finest resolution: about as many cells as vertices.
  [[nodiscard]] static std::size_t finest_width(std::size_t vertices) noexcept {
    std::size_t width = 1;
    while (width < 64 && 6 * width * width * 2 < vertices) width *= 2;
    return width;
  }
  /// The directions at the corners of a cell of a face that is `width` cells wide.
  [[nodiscard]] static std::array<Vec3, 4> corners_of(std::size_t face, std::size_t width,
                                                      std::size_t row, std::size_t column);
  [[nodiscard]] std::span<const std::uint32_t> candidates_of(std::size_t cell) const noexcept {
    return {candidates_.data() + first_[cell], first_[cell + 1] - first_[cell]};
  }
  /// The table of cells half as wide.
  [[nodiscard]] SupportTable refined(std::span<const Vec3> vertices, double margin) const;
  /// Adds a cell with those corners.
  void add_cell(std::span<const Vec3> vertices, double margin, std::span<const std::uint32_t> list,
                const std::array<Vec3, 4>& corners);

  std::size_t width_ = 1;             ///< cells along the edge of a face
  std::vector<std::uint32_t> first_;  ///< start of the candidates of each cell, and the end
  List candidates_;
};

inline std::array<Vec3, 4> SupportTable::corners_of(std::size_t face, std::size_t width,
                                                    std::size_t row, std::size_t column) {
  std::array<Vec3, 4> corners;
  const auto along = [&](std::size_t step) {
    return 2.0 * static_cast<double>(step) / static_cast<double>(width) - 1.0;
  };
  const std::size_t axis = face / 2;
  for (std::size_t k = 0; k < 4; ++k) {
    corners[k][axis] = face % 2 == 0 ? 1.0 : -1.0;
    corners[k][(axis + 1) % 3] = along(column + k % 2);
    corners[k][(axis + 2) % 3] = along(row + k / 2);
  }
  return corners;
}

/// Its candidates are the vertices of `list` that no other one exceeds by `margin` along all four
/// corners, or duplicates. Only 32 vertices, by descending sum, are tested as dominating ones; more
/// would hardly shorten a long list.
inline void SupportTable::add_cell(std::span<const Vec3> vertices, double margin,
                                   std::span<const std::uint32_t> list,
                                   const std::array<Vec3, 4>& corners) {
  // For each vertex the products with the four corners, and their sum.
  std::vector<double> reaches(5 * list.size());
  const auto reach = [&](std::size_t i, std::size_t k) -> double& { return reaches[5 * i + k]; };
  // The places in `list` of those that are neither dominating nor dominated, `count` of them.
  List open(list.size());
  std::size_t count = open.size();
  std::size_t first = 0;  // of them, by descending sum
  for (std::size_t i = 0; i < list.size(); ++i) {
    open[i] = static_cast<std::uint32_t>(i);
    for (std::size_t k = 0; k < 4; ++k) {
      reach(i, k) = dot(corners[k], vertices[list[i]]);
      reach(i, 4) += reach(i, k);
    }
    if (reach(i, 4) > reach(first, 4)) first = i;
  }
  std::vector<char> is_dominated(list.size());
  for (int dominating = 0; dominating < 32 && count > 0; ++dominating) {
    const std::size_t best = first;
    const auto dominates = [&](std::size_t i) {
      for (std::size_t k = 0; k < 4; ++k) {
        if (!(reach(best, k) - reach(i, k) > margin)) {
          return is_same(vertices[list[best]], vertices[list[i]]);
        }
      }
      return true;
    };
    std::size_t left = 0;
    for (std::size_t k = 0; k < count; ++k) {
      const std::uint32_t i = open[k];
      if (i == best) continue;
      is_dominated[i] = dominates(i) ? 1 : 0;
      if (is_dominated[i] != 0) continue;
      if (left == 0 || reach(i, 4) > reach(first, 4)) first = i;
      open[left++] = i;
    }
    count = left;
  }
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (is_dominated[i] == 0) candidates_.push_back(list[i]);
  }
  first_.push_back(static_cast<std::uint32_t>(candidates_.size()));
}

inline SupportTable SupportTable::refined(std::span<const Vec3> vertices, double margin) const {
  SupportTable finer;
  finer.width_ = 2 * width_;
  finer.first_.push_back(0);
  const std::size_t width = finer.width_;
  for (std::size_t i = 0; i < 6 * width * width; ++i) {
    const std::size_t face = i / (width * width);
    const std::size_t row = i / width % width;
    const std::size_t column = i % width;
    finer.add_cell(vertices, margin, candidates_of((face * width_ + row / 2) * width_ + column / 2),
                   corners_of(face, width, row, column));
  }
  return finer;
}

inline SupportTable::SupportTable(std::span<const Vec3> vertices) {
  List all(vertices.size());
  double size = 0.0;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    all[i] = static_cast<std::uint32_t>(i);
    size = std::max(size, largest_entry(vertices[i]));
  }
  // A dot product rounds by at most 9 half ulps of the size, a direction moves within its cell by 4
  // half ulps: together 60 half ulps between two vertices.
  const double margin = 64.0 * std::numeric_limits<double>::epsilon() * size;
  first_.push_back(0);
  for (std::size_t face = 0; face < 6; ++face) {
    add_cell(vertices, margin, {all.data(), all.size()}, corners_of(face, 1, 0, 0));
  }
  while (width_ < finest_width(vertices.size())) {
    SupportTable finer = refined(vertices, margin);
    if (finer.candidates_.size() > most_candidates * vertices.size()) break;
    *this = std::move(finer);
  }
  // Copies hold no more memory than they need.
  first_ = List(first_);
  candidates_ = List(candidates_);
}

}  // namespace repel
