// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A map of cubes kept up to date by depth images.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <octomap/OcTree.h>

#include <repel/octrees/grid.hpp>
#include <repel/percepts/depth_camera.hpp>

namespace repel::octrees {

/// How images are entered in a map.
struct DepthMapOptions {
  double cube = 0.05;  ///< [m] edge of a cube, 0.001 to 10
  double slack = 0.0;  ///< [m] a point this near to an occupied cube counts as in it, so camera
                       ///< noise changes no cubes; 0 to a quarter of `cube`
  int frees = 3;       ///< images that see through an occupied cube until it is free, 1 to 1000
  double keeps = 2.0;  ///< [s] how long a cube stays occupied in which only the robot is seen, 0 to
                       ///< 1e6
  Region region{};     ///< of which there is a map
};

/// Enters depth images in an octree: a cube with a measured point is occupied, or with a `slack` an
/// occupied one within it. It stays so while out of sight, and is free again after several images
/// have seen through it. Pixels with a negative depth show the robot (percepts::OwnBody): the space
/// before them is free; their end is neither, as its margin may hide something else.
class DepthMap {
 public:
  /// @throws SetupError for a number out of range, or a region of too many cubes
  explicit DepthMap(const percepts::DepthCamera& camera, const DepthMapOptions& options = {});

  /// @param depth [m] width x height of the camera; a shorter image is as if nothing was measured
  /// @param X_WC [m] the camera in the frame of the map when it was taken @param time [s] of the
  /// image, not before that of the last one @return cubes with a measurement. Cost: about 15 ns a
  /// pixel, and 3 ns for each cube on a ray; rays are a quarter to half a cube apart
  int insert(std::span<const float> depth, const Pose& X_WC, double time);

  /// The map, as of the last image.
  [[nodiscard]] const octomap::OcTree& tree() const noexcept { return tree_; }
  [[nodiscard]] const DepthMapOptions& options() const noexcept { return options_; }  ///< as given

 private:
  enum class State : std::uint8_t { unknown, free, occupied };
  /// What an image says of a cube; the greater one counts.
  enum class Mark : std::uint8_t { none, free, hidden, hit };

  /// The cube that a measured point [m] makes, or keeps, occupied. @param own in which it is
  [[nodiscard]] octomap::OcTreeKey taken_for(const octomap::point3d& p,
                                             const octomap::OcTreeKey& own) const;
  [[nodiscard]] bool is_taken(const octomap::OcTreeKey& key) const noexcept;
  /// The place of a cube in the lists; `places_` if it is not in the region.
  [[nodiscard]] std::size_t place_of(const octomap::OcTreeKey& key) const noexcept {
    return place_at(key[0] - low_[0], key[1] - low_[1], key[2] - low_[2]);
  }
  /// The same for a cube counted from the first of the region.
  [[nodiscard]] std::size_t place_at(int x, int y, int z) const noexcept {
    const auto u = static_cast<unsigned>(x);
    const auto v = static_cast<unsigned>(y);
    const auto w = static_cast<unsigned>(z);
    if (u >= size_[0] || v >= size_[1] || w >= size_[2]) return places_;
    return (std::size_t{w} * size_[1] + v) * size_[0] + u;
  }
  void mark(const octomap::OcTreeKey& key, Mark what);
  void mark_pixels(std::span<const float> depth, const Pose& X_WC);
  /// Marks the cubes between two points [m] as free, but not that of the end.
  void mark_ray(const octomap::point3d& begin, const octomap::point3d& end);
  void settle(std::size_t place, const octomap::OcTreeKey& key, double time);

  percepts::DepthCamera camera_;
  DepthMapOptions options_;
  octomap::OcTree tree_;
  std::array<int, 3> low_{};        ///< the first cube of the region, in OctoMap's count
  std::array<unsigned, 3> size_{};  ///< cubes of the region
  std::size_t places_ = 0;
  // By place:
  std::vector<Mark> marks_;    ///< of this image
  std::vector<State> states_;  ///< as in the tree
  std::vector<float> hit_at_;  ///< [s] when something was last measured there
  std::vector<octomap::OcTreeKey> marked_;
};

}  // namespace repel::octrees
