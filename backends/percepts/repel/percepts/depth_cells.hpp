// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Divides depth images into few convex cells containing everything seen.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <repel/percepts/depth_camera.hpp>

namespace repel::percepts {

/// How images are divided.
struct CellOptions {
  int most = 200;    ///< cells of an image; at least twice the blocks of `largest`
  int largest = 64;  ///< [px] edge of the blocks to begin with; `smallest` times a power of 2
  int smallest = 4;  ///< [px] edge below which no block is divided
  double tolerance = 0.01;  ///< [m] by which a surface may deviate from the plane of its cell
  double thickness = 0.05;  ///< [m] along the optical axis, of what is behind a surface
  double room = 1.0;        ///< [m] largest reach of a cell from its centre
};

/// What was seen in a rectangle of pixels, as the convex hull of eight corners: those of the
/// rectangle, half a pixel around it, at two depths.
struct Cell {
  std::int16_t u = 0;            ///< [px] its first column
  std::int16_t v = 0;            ///< [px] its first row
  std::int16_t width = 0;        ///< [px]
  std::int16_t height = 0;       ///< [px]
  std::int16_t layer = 0;        ///< number of cells of the same rectangle before it
  std::array<float, 4> front{};  ///< [m] depth of the near corners, row by row
  std::array<float, 4> back{};   ///< [m] of the far ones

  /// The corners [m] in the frame of the camera: four near ones, then the four behind them.
  [[nodiscard]] std::array<Vec3, 8> corners(const DepthCamera& camera) const noexcept;
};

/// What is known of the division of an image.
struct DivisionReport {
  int measured = 0;        ///< [px] with a depth
  double tolerance = 0.0;  ///< [m] with which the cells were few enough
  int smallest = 0;        ///< [px] edge of the smallest blocks, likewise
  int too_large = 0;       ///< cells beyond `CellOptions::room`
};

/// Divides images, block by block. The inverse depth of a plane is linear in the image, so one cell
/// fits a block showing a plane of any inclination. Other blocks are divided into four, the
/// smallest ones at their largest gap in depth. If there are too many cells, again with twice the
/// tolerance and the smallest blocks twice as large; the next images begin so too, until there are
/// few. So every measured point lies in a cell. Every cell begins at most that tolerance
/// before its nearest point, but for the smallest blocks and those measured in part. All memory is
/// allocated at construction.
class DepthCells {
 public:
  /// @throws SetupError for a number out of range
  explicit DepthCells(const DepthCamera& camera, const CellOptions& options = {});

  /// @param depth [m] width x height of the camera; a shorter image counts as measured nowhere
  /// @return cells; valid until the next call. Cost: 1 to 3 ms for 320 x 240
  std::span<const Cell> divide(std::span<const float> depth) noexcept;

  /// Whether the image last divided has a depth in some pixel of the rectangle of `cell`.
  [[nodiscard]] bool measures_in(const Cell& cell) const noexcept;
  /// What is known of the last division.
  [[nodiscard]] const DivisionReport& report() const noexcept { return report_; }
  [[nodiscard]] const DepthCamera& camera() const noexcept { return camera_; }    ///< as given
  [[nodiscard]] const CellOptions& options() const noexcept { return options_; }  ///< as given

 private:
  struct Block {
    int u, v, edge;  ///< [px]
  };
  struct Fit;

  /// False if there are too many cells.
  bool divide_with(double tolerance, int smallest) noexcept;
  void open_quarters(const Block& block) noexcept;
  bool add(const Cell& cell) noexcept;
  bool add_layers(const Block& block) noexcept;
  [[nodiscard]] Fit fit(const Block& block) const noexcept;
  void set_depths(Cell& cell, double front, double back) const noexcept;
  [[nodiscard]] bool put_around(const Fit& fitted, double tolerance, Cell& cell) const noexcept;
  [[nodiscard]] bool has_room(const Cell& cell) const noexcept;
  [[nodiscard]] Cell cell_of(const Block& block) const noexcept;

  DepthCamera camera_;
  CellOptions options_;
  std::vector<float> inverse_;  ///< [1/m] of every pixel; 0: not measured
  std::vector<Cell> cells_;
  std::vector<Block> open_;
  std::vector<float> sorted_;  ///< of a block
  std::size_t count_ = 0;
  int coarser_ = 0;  ///< how often tolerance and smallest blocks were doubled
  DivisionReport report_;
};

}  // namespace repel::percepts
