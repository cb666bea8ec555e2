// SPDX-License-Identifier: BSD-3-Clause
#include <repel/percepts/depth_cells.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include <Eigen/Dense>

namespace repel::percepts {
namespace {

const CellOptions& checked_options(const DepthCamera& camera, const CellOptions& options) {
  repel::checked("smallest block", options.smallest, 1.0, 256.0, "px");
  repel::checked("largest block", options.largest, options.smallest, 1024.0, "px");
  int edge = options.largest;
  while (edge > options.smallest) {
    if (edge % 2 != 0) break;
    edge /= 2;
  }
  if (edge != options.smallest) {
    throw SetupError("largest block of " + std::to_string(options.largest) + " px; allowed: " +
                     std::to_string(options.smallest) + " px, the smallest, times a power of 2");
  }
  const auto blocks_of = [&](int pixels) { return (pixels - 1) / options.largest + 1; };
  const int blocks = blocks_of(camera.width) * blocks_of(camera.height);
  repel::checked("most cells", options.most, 2.0 * blocks, 1e6, "");
  repel::checked("tolerance", options.tolerance, 1e-5, 1.0, "m");
  repel::checked("thickness", options.thickness, 0.0, 10.0, "m");
  repel::checked("room", options.room, 1e-3, 1e3, "m");
  return options;
}

/// Covers the rounding of depths in single precision.
constexpr double rounding = 1e-6;

}  // namespace

void is_built_for(EigenAlignmentHere /*alignment*/, VectorRegisterHere /*size*/) noexcept {}

/// The plane of a block, as inverse depth [1/m] over the image: w + du (u - u0) + dv (v - v0), with
/// (u0, v0) the middle of the block, and how far the pixels are from it.
struct DepthCells::Fit {
  int pixels = 0;
  double w = 0.0, du = 0.0, dv = 0.0;
  double deviation = 0.0;                                              ///< [1/m] largest
  double least = std::numeric_limits<double>::infinity(), most = 0.0;  ///< [1/m] of the pixels
};

std::array<Vec3, 8> Cell::corners(const DepthCamera& camera) const noexcept {
  std::array<Vec3, 8> all;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3 ray = camera.ray(u - 0.5 + (i % 2 == 0 ? 0 : width), v - 0.5 + (i < 2 ? 0 : height));
    all[i] = front[i] * ray;
    all[i + 4] = back[i] * ray;
  }
  return all;
}

DepthCells::DepthCells(const DepthCamera& camera, const CellOptions& options)
    : camera_(checked(camera)),
      options_(checked_options(camera_, options)),
      inverse_(camera_.pixels()),
      cells_(static_cast<std::size_t>(options_.most)),
      sorted_(static_cast<std::size_t>(options_.largest) *
              static_cast<std::size_t>(options_.largest)) {
  const int columns = (camera_.width - 1) / options_.largest + 1;
  const int rows = (camera_.height - 1) / options_.largest + 1;
  open_.reserve(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows) + 64);
}

std::span<const Cell> DepthCells::divide(std::span<const float> depth) noexcept {
  report_ = {};
  for (std::size_t i = 0; i < inverse_.size(); ++i) {
    const bool is_measured = i < depth.size() && camera_.measures(depth[i]);
    inverse_[i] = is_measured ? 1.0F / depth[i] : 0.0F;
    report_.measured += is_measured ? 1 : 0;
  }
  // Once no block is divided and the tolerance is beyond all depths, each is one cell: it ends.
  for (;; ++coarser_) {
    report_.tolerance = std::ldexp(options_.tolerance, coarser_);
    report_.smallest =
        static_cast<int>(std::min(std::ldexp(options_.smallest, coarser_), 1.0 * options_.largest));
    if (divide_with(report_.tolerance, report_.smallest)) break;
  }
  // Half the blocks can be four times as many cells.
  if (coarser_ > 0 && 4 * count_ < cells_.size()) --coarser_;
  return {cells_.data(), count_};
}

bool DepthCells::measures_in(const Cell& cell) const noexcept {
  for (int v = cell.v; v < cell.v + cell.height; ++v) {
    const float* const row = &inverse_[camera_.at(0, v)];
    if (std::any_of(row + cell.u, row + cell.u + cell.width, [](float w) { return w > 0.0F; })) {
      return true;
    }
  }
  return false;
}

bool DepthCells::divide_with(double tolerance, int smallest) noexcept {
  count_ = 0;
  report_.too_large = 0;
  open_.clear();
  for (int v = 0; v < camera_.height; v += options_.largest) {
    for (int u = 0; u < camera_.width; u += options_.largest) {
      open_.push_back({u, v, options_.largest});
    }
  }
  while (!open_.empty()) {
    const Block block = open_.back();
    open_.pop_back();
    const Fit fitted = fit(block);
    if (fitted.pixels == 0) continue;
    // An error dw of the inverse depth w is one of dw / w^2 of the depth.
    const double deviation = fitted.deviation / (fitted.least * fitted.least);
    const bool is_last_resort = tolerance > camera_.farthest;
    const bool is_smallest = block.edge == smallest;
    Cell cell = cell_of(block);
    const bool is_plane = put_around(fitted, tolerance, cell) && deviation <= tolerance;
    const bool fits = has_room(cell);
    if ((is_plane && fits) || is_last_resort) {
      report_.too_large += fits ? 0 : 1;
      if (!add(cell)) return false;
    } else if (is_smallest) {
      if (!add_layers(block)) return false;
    } else {
      open_quarters(block);
    }
  }
  return true;
}

void DepthCells::open_quarters(const Block& block) noexcept {
  const int half = block.edge / 2;
  for (const int dv : {0, half}) {
    for (const int du : {0, half}) {
      const Block quarter{block.u + du, block.v + dv, half};
      if (quarter.u < camera_.width && quarter.v < camera_.height) open_.push_back(quarter);
    }
  }
}

/// Lets a cell reach from one plane to another that are as inclined as that of the fit. False, and
/// from one depth to another, if these planes would reach much farther than what was seen: a few
/// pixels at the edge of a block say little of its plane.
bool DepthCells::put_around(const Fit& fitted, double tolerance, Cell& cell) const noexcept {
  const double margin = fitted.deviation + rounding;
  double least = std::numeric_limits<double>::infinity(), most = 0.0;  // [1/m] at the corners
  for (std::size_t i = 0; i < 4; ++i) {
    const double u = (i % 2 == 0 ? -0.5 : 0.5) * cell.width;
    const double v = (i < 2 ? -0.5 : 0.5) * cell.height;
    const double w = fitted.w + fitted.du * u + fitted.dv * v;
    least = std::min(least, w - margin);
    most = std::max(most, w + margin);
    cell.front[i] = static_cast<float>(1.0 / (w + margin));
    cell.back[i] = static_cast<float>(1.0 / (w - margin) + options_.thickness);
  }
  const double seen = 1.0 / fitted.least - 1.0 / fitted.most;
  const bool reaches_too_far =
      least < 0.5 / camera_.farthest || 1.0 / least - 1.0 / most > 2.0 * (seen + tolerance);
  if (reaches_too_far) set_depths(cell, fitted.most, fitted.least);
  return !reaches_too_far;
}

/// Lets a cell reach from one inverse depth [1/m] to another, and by its thickness behind it.
void DepthCells::set_depths(Cell& cell, double front, double back) const noexcept {
  cell.front.fill(static_cast<float>(1.0 / (front + rounding)));
  cell.back.fill(static_cast<float>(1.0 / (back - rounding) + options_.thickness));
}

bool DepthCells::add(const Cell& cell) noexcept {
  if (count_ == cells_.size()) return false;
  cells_[count_++] = cell;
  return true;
}

/// One cell for what is before the largest gap in the inverse depths, one for what is behind it;
/// more where these would be too long.
bool DepthCells::add_layers(const Block& block) noexcept {
  Cell cell = cell_of(block);
  std::size_t n = 0;
  for (int v = cell.v; v < cell.v + cell.height; ++v) {
    for (int u = cell.u; u < cell.u + cell.width; ++u) {
      const float w = inverse_[camera_.at(u, v)];
      if (w > 0.0F) sorted_[n++] = w;
    }
  }
  const auto begin = sorted_.begin();
  std::sort(begin, begin + static_cast<std::ptrdiff_t>(n), std::greater<>());
  std::size_t behind = n;  // the first behind the largest gap
  float gap = 0.0F;
  for (std::size_t i = 1; i < n; ++i) {
    if (sorted_[i - 1] - sorted_[i] <= gap) continue;
    gap = sorted_[i - 1] - sorted_[i];
    behind = i;
  }
  for (std::size_t first = 0; first < n; ++cell.layer) {
    const double longest = 1.0 / sorted_[first] + 0.5 * options_.room;
    std::size_t end = first + 1;
    while (end < n && end != behind && 1.0 / sorted_[end] <= longest) ++end;
    set_depths(cell, sorted_[first], sorted_[end - 1]);
    report_.too_large += has_room(cell) ? 0 : 1;
    if (!add(cell)) return false;
    first = end;
  }
  return true;
}

Cell DepthCells::cell_of(const Block& block) const noexcept {
  Cell cell;
  cell.u = static_cast<std::int16_t>(block.u);
  cell.v = static_cast<std::int16_t>(block.v);
  cell.width = static_cast<std::int16_t>(std::min(block.edge, camera_.width - block.u));
  cell.height = static_cast<std::int16_t>(std::min(block.edge, camera_.height - block.v));
  return cell;
}

bool DepthCells::has_room(const Cell& cell) const noexcept {
  const std::array<Vec3, 8> corners = cell.corners(camera_);
  Vec3 middle(0, 0, 0);
  for (const Vec3& p : corners) middle += p / 8.0;
  return std::all_of(corners.begin(), corners.end(),
                     [&](const Vec3& p) { return norm(p - middle) <= options_.room; });
}

DepthCells::Fit DepthCells::fit(const Block& block) const noexcept {
  const Cell cell = cell_of(block);
  const double u0 = cell.u - 0.5 + 0.5 * cell.width;
  const double v0 = cell.v - 0.5 + 0.5 * cell.height;
  Fit fit;
  double uu = 0, uv = 0, vv = 0, su = 0, sv = 0, sw = 0, uw = 0, vw = 0;
  const auto for_each = [&](const auto& see) {
    for (int v = cell.v; v < cell.v + cell.height; ++v) {
      const float* const row = &inverse_[camera_.at(0, v)];
      for (int u = cell.u; u < cell.u + cell.width; ++u) {
        if (row[u] > 0.0F) see(u - u0, v - v0, static_cast<double>(row[u]));
      }
    }
  };
  for_each([&](double u, double v, double w) {
    ++fit.pixels;
    uu += u * u, uv += u * v, vv += v * v;
    su += u, sv += v, sw += w;
    uw += u * w, vw += v * w;
    fit.least = std::min(fit.least, w);
    fit.most = std::max(fit.most, w);
  });
  if (fit.pixels == 0) return fit;
  const double n = fit.pixels;
  Eigen::Matrix3d A;
  A << n, su, sv, su, uu, uv, sv, uv, vv;
  // Too few pixels, or all on a line, say nothing of the inclination.
  if (A.determinant() > 1e-6 * n * n * n) {
    const Eigen::Vector3d x = A.inverse() * Eigen::Vector3d(sw, uw, vw);
    fit.w = x[0], fit.du = x[1], fit.dv = x[2];
  } else {
    fit.w = sw / n;
  }
  for_each([&](double u, double v, double w) {
    fit.deviation = std::max(fit.deviation, std::abs(fit.w + fit.du * u + fit.dv * v - w));
  });
  return fit;
}

}  // namespace repel::percepts
