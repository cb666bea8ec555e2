// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The messages to the page, as JSON text; docs/live_view.md describes the format.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <repel/base/layout.hpp>
#include <repel/common/deadline.hpp>
#include <repel/geometry/triangle_mesh.hpp>
#include <repel/loop/tap.hpp>
#include <repel/visual/arm_info.hpp>
#include <repel/visual/controls.hpp>

namespace repel::visual {

/// Defined for the compiler flags of this library: a program with incompatible flags does not link.
void is_built_for(EigenAlignmentHere, VectorRegisterHere) noexcept;
/// Makes the program link `is_built_for`.
[[gnu::used, gnu::retain]] constexpr auto built_alike = &is_built_for;

/// Gaps of a mesh: its surface outside all of its convex parts.
struct GapsInfo {
  /// One such place.
  struct Gap {
    Vec3 p_P{0, 0, 0};   ///< [m] a point of it
    double depth = 0.0;  ///< [m] no point of it is farther from the parts
  };

  PartId part;               ///< the points are in its frame
  std::size_t count = 0;     ///< of all such places
  std::vector<Gap> deepest;  ///< some of them, the deepest first
};

/// What a page is told of a part besides its shape: without any force. It stays when the part gets
/// another shape.
struct LookInfo {
  PartId part;       ///< of the world
  std::string of{};  ///< name of what it is one of several parts of; empty: it is all
  std::optional<std::array<double, 3>>
      color{};                      ///< red, green, blue, sRGB, 0 to 1; none: as others
  std::optional<double> opacity{};  ///< above 0, to 1; none: as others
};

/// The visual of a link of an arm or its stand: without any force.
struct VisualInfo {
  std::string name;              ///< as in "base_link"
  BodyId body{};                 ///< that it moves with; World::fixed: none. Unused with a `link`
  int arm = -1;                  ///< that it belongs to
  Pose X_BV = Pose::Identity();  ///< [m] in its body or link
  std::optional<std::array<double, 4>> color{};  ///< red, green, blue, opacity, 0 to 1
  TriangleMesh mesh{};                           ///< [m] in its own frame V
  /// Index, base outward, of a moving link without a body in the world, placed by
  /// ArmInfo::kinematics; -1: it moves with `body`.
  int link = -1;
};

/// Properties that are constant while a scene runs.
struct SceneInfo {
  std::string scene;                ///< its name
  double rate_hz = 400.0;           ///< [Hz]
  bool replay = false;              ///< replay of a recording
  double duration = 0.0;            ///< [s] 0: until it is stopped
  std::vector<ArmInfo> arms;        ///< in the order of the cell
  std::vector<PartId> spare;        ///< reserved for boxes from a page
  std::vector<GapsInfo> gaps;       ///< of the meshes that are not covered as a whole
  std::vector<LookInfo> looks;      ///< of parts of which more is told than their shape
  std::vector<VisualInfo> visuals;  ///< what the arms look like
};

/// `scene`: bodies, parts with their levels as meshes, pairs, arms. Takes milliseconds.
/// @throws SetupError for a visual of a link that its arm does not have, or has no kinematics for
[[nodiscard]] std::string scene_message(const SceneInfo& info, const World& world);

/// `part`: a part with a new shape.
[[nodiscard]] std::string part_message(PartId id, const Shape& shape);

/// `parts`: the same of several, by their indices.
[[nodiscard]] std::string parts_message(const std::map<std::int32_t, Shape>& shapes);

/// `depth`: the last image of a camera.
[[nodiscard]] std::string depth_message(const std::string& camera, const DepthView& view);

/// `frame`: one picture, and a few values of every tick since the last.
[[nodiscard]] std::string frame_message(const SceneInfo& info, const World& world,
                                        const Snapshot& shot, std::span<const TickSample> recent,
                                        bool running);

/// Histograms and counts over all ticks.
struct Timing {
  DurationHistogram compute;               ///< of the ticks alone
  DurationHistogram late;                  ///< how late they began
  std::vector<std::int64_t> compute_bins;  ///< one for each interval between edges
  std::vector<std::int64_t> late_bins;     ///< likewise, of the lateness
  std::int64_t ticks = 0;                  ///< number of ticks
  std::int64_t misses = 0;   ///< ticks not finished within one period of their due time
  std::int64_t dropped = 0;  ///< ticks without data

  /// Edges [us] of the bins: ten to each decade, from 0.1 us to 0.1 s.
  [[nodiscard]] static const std::vector<double>& edges();

  Timing();
  /// Adds a tick. @param period between two ticks.
  void add(const TickTimes& times, std::chrono::nanoseconds period);
};

/// `timing`.
[[nodiscard]] std::string timing_message(const Timing& timing);

}  // namespace repel::visual
