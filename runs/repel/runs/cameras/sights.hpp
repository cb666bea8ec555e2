// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Poses of everything in a scene visible to cameras.
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <repel/cell/cell.hpp>
#include <repel/geometry/triangle_mesh.hpp>
#include <repel/loop/record.hpp>
#include <repel/robots/robot.hpp>
#include <repel/scene/scene.hpp>
#include <repel/world/kinematics.hpp>

namespace repel::runs {

/// The least signed distance of an arm or its tool from the hidden parts: those seen by cameras and
/// unknown to the world model. From the parts themselves, not from those made of images.
struct Clearance {
  double least = std::numeric_limits<double>::infinity();  ///< [m]
  std::string pair;                                        ///< "part - hidden"; empty: none
};

/// Poses of everything in a scene visible to a camera.
class Sights {
 public:
  /// @param robots of the arms of the cell, in their order
  Sights(const scene::Scene& scene, const std::vector<Robot>& robots, const Cell& cell);

  /// The poses [m] in the world after a tick, in the order of `meshes`; not finite: not there. The
  /// first are in the world model, the others hidden.
  void place(std::span<const TickRecord* const> records, std::vector<Pose>& X_W) noexcept;

  [[nodiscard]] std::vector<TriangleMesh> meshes() const;
  /// The shapes of those in the world model.
  [[nodiscard]] std::vector<Shape> known() const;
  [[nodiscard]] std::size_t size() const noexcept { return sights_.size(); }

  /// Keeps the least distance of arms and tools from hidden parts at these poses.
  void measure(const std::vector<Pose>& X_W, Clearance& clearance) const;

 private:
  struct Sight {
    std::string name;
    Shape shape;
    Pose X = Pose::Identity();  ///< [m] in its link, in its tool frame, or in the world
    int arm = -1;               ///< -1: none
    int link = 0;               ///< of the arm; -1: its base
    bool is_tool = false;
    bool is_hidden = false;
    PartId loose{};  ///< that can come and go
    std::optional<ReciprocatingMotion> motion{};
  };

  [[nodiscard]] Pose pose_of(const Sight& sight, double time) const noexcept;

  const Cell& cell_;
  std::vector<Kinematics> kinematics_;
  std::vector<std::size_t> joints_;
  std::vector<Sight> sights_;
};

}  // namespace repel::runs
