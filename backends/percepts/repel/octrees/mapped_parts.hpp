// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Keeps the parts of a running world in step with an octree.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include <repel/octrees/grid.hpp>
#include <repel/schedule/world_changes.hpp>

namespace repel::octrees {

/// Which region becomes parts, and how.
struct MappedOptions {
  int most = 200;                ///< boxes, 1 to 100000
  bool is_unseen_solid = false;  ///< what the tree does not know, within the region
  Region region{};               ///< what is occupied outside of it is left out
  double room = 1.0;             ///< [m] largest reach of a box from its centre, 0.001 to 100
  double slack = 0.0;            ///< [m] boxes are larger by it on all sides, 0 to 0.1: that of the
                                 ///< map, DepthMapOptions
  double over = 0.05;            ///< [s] in which parts come and go, 0 to 10
  ReservedShare share{};         ///< of the reserved parts, for this map alone
  /// Is told of every new part with its shape, for displays; may be empty.
  std::function<void(PartId, const Shape&)> on_add{};
};

/// Changes by a version of the tree, and its boxes.
struct MapCounts {
  int boxes = 0;      ///< that the tree needs with these cubes
  int kept = 0;       ///< of these, that are parts already
  int added = 0;      ///< of these, that have become parts
  int left_out = 0;   ///< of these, beyond `most` or without a reserved part that is free
  int removed = 0;    ///< parts that are none of the boxes now
  double cube = 0.0;  ///< [m] edge of the cubes used: that of the tree, or 2, 4, 8 ... times as
                      ///< large to have few enough; a large one is solid if any within it is
};

/// Makes the solid cubes of an octree loose parts of a world: boxes containing every solid cube
/// and, but for a slack, nothing else. A box still solid stays as it is, so unchanged regions of
/// the tree change no parts. New boxes are added before the replaced ones are removed. If they are
/// more than `most`, they are made anew, then with cubes twice as large, until they are few enough
/// or a cube would have no room; with smaller cubes again when these need at most 70 % of `most`.
/// For one thread, the only user of these `WorldChanges`; it may allocate.
class MappedParts {
 public:
  /// @param resolution [m] edge of the cubes of the trees @param changes must outlive this object.
  /// The share should be of twice `most` parts, with the room of the boxes (World::reserve)
  /// @throws SetupError for a number out of range, a region of too many cubes, or cubes without
  /// room
  MappedParts(double resolution, WorldChanges& changes, const MappedOptions& options = {});

  /// Takes over a version of the tree. Cost: `grid_of`; 1 ns for each cube of the region; and a
  /// microsecond for each solid cube that is in no part yet
  /// @throws SetupError for a tree of another resolution
  MapCounts see(const octomap::OcTree& tree);
  /// Lets all parts go.
  void clear();

  /// The boxes that are parts, in cubes of the trees, counted from the origin of the map.
  [[nodiscard]] std::vector<cover::CubeRange> boxes() const;
  [[nodiscard]] std::size_t size() const noexcept { return parts_.size(); }  ///< number of parts

 private:
  struct Mapped {
    cover::CubeRange cubes;
    PartId part;
    bool stays = true;
  };
  class Plan;

  /// The boxes for cubes 2^level times as large, as many as there may be.
  [[nodiscard]] std::vector<cover::CubeRange> planned(const cover::OccupancyGrid& fine,
                                                      MapCounts& counts);
  void take_over(const std::vector<cover::CubeRange>& boxes, MapCounts& counts);
  bool add(const cover::CubeRange& cubes);
  bool remove(const Mapped& part) { return changes_->remove(part.part, options_.over); }

  double resolution_;  ///< [m]
  WorldChanges* changes_;
  MappedOptions options_;
  double reach_;            ///< [m] largest of a box without its slack
  cover::CubeRange range_;  ///< of the region
  int level_ = 0;           ///< how often cubes are doubled
  int most_level_ = 0;
  std::vector<Mapped> parts_;
};

}  // namespace repel::octrees
