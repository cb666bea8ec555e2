// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Keeps the parts of a running world in step with what a camera sees.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include <repel/percepts/depth_cells.hpp>
#include <repel/schedule/world_changes.hpp>

namespace repel::percepts {

/// How cells become parts.
struct PerceivedOptions {
  double slack = 0.01;    ///< [m] growth of parts at the front and back, so camera noise changes
                          ///< none
  double over = 0.05;     ///< [s] in which parts come and go
  double keeps = 2.0;     ///< [s] how long what is hidden stays after it was last seen
  ReservedShare share{};  ///< of the reserved parts, for this camera alone
  /// Is told of every new part with its shape, for displays; may be empty.
  std::function<void(PartId, const Shape&)> on_add{};
};

/// What an image has changed.
struct PerceptCounts {
  int cells = 0;     ///< of the image
  int kept = 0;      ///< of these, in the place of an existing part
  int added = 0;     ///< of these, that have become a part
  int left_out = 0;  ///< of these, for which no reserved part was free
  int removed = 0;   ///< parts that are no longer seen
  int hidden = 0;    ///< parts kept without a measurement at their place
};

/// Makes the cells of depth images parts of a world that come and go. A cell in the place of an
/// existing part changes nothing. A new part is added before the replaced one is removed. A part in
/// front of which nothing is measured, as when the robot hides it, stays for a while. For one
/// thread, the only user of these `WorldChanges`; it may allocate. Several cameras have an object
/// each, with shares that have no part in common.
class PerceivedParts {
 public:
  /// @param changes must outlive this object. The share should be twice as many parts as there are
  /// cells, with the room of these (World::reserve)
  /// @throws SetupError for a number out of range
  explicit PerceivedParts(WorldChanges& changes, const PerceivedOptions& options = {});

  /// Takes over an image. @param cells of `division`, as it returned them @param X_WC [m] the
  /// camera when it was taken; if the camera has moved, all parts are new @param time [s] of the
  /// image
  PerceptCounts see(std::span<const Cell> cells, const DepthCells& division, const Pose& X_WC,
                    double time);
  /// Lets all parts go.
  void clear();

  /// Parts there are.
  [[nodiscard]] std::size_t size() const noexcept { return parts_.size(); }
  /// [s] Of the last image; minus infinity before it.
  [[nodiscard]] double seen_at() const noexcept { return seen_at_; }

 private:
  struct Perceived {
    Cell cell;  ///< grown
    PartId part;
    double seen_at = 0.0;  ///< [s]
    bool is_seen = false;  ///< in this image
  };

  [[nodiscard]] bool is_where(const Perceived& part, const Cell& cell) const noexcept;
  [[nodiscard]] bool add(const Cell& cell, const DepthCamera& camera, double time);

  WorldChanges* changes_;
  PerceivedOptions options_;
  std::vector<Perceived> parts_;
  std::vector<Cell> waiting_;
  Pose X_WC_ = Pose::Identity();  ///< [m] of the last image
  double seen_at_;
};

}  // namespace repel::percepts
