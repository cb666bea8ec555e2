// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Covers a mesh by overlapping convex parts, with proven bounds.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <repel/base/layout.hpp>
#include <repel/geometry/triangle_mesh.hpp>

namespace repel::cover {

/// Defined for the compiler flags of this library: a program with incompatible flags does not link.
void is_built_for(EigenAlignmentHere, VectorRegisterHere) noexcept;
/// Makes the program link `is_built_for`.
[[gnu::used, gnu::retain]] constexpr auto built_alike = &is_built_for;

/// The engine dividing the mesh.
enum class Engine : std::uint8_t {
  automatic,  ///< one hull if that is within the error, otherwise planes
  planes,     ///< cuts by planes of the mesh: built in
  coacd,      ///< the library of the PyPI package coacd
  hacd,       ///< HACD of Bullet's extras, if it is built in
  hull        ///< one convex hull
};

/// How a mesh is divided.
struct CoverOptions {
  int parts = 32;         ///< at most; 1 to 1000
  double error = 2e-3;    ///< [m] that parts may reach out of the mesh; 1e-6 to 1
  double overlap = 5e-3;  ///< [m] that parts reach into their neighbours; 0 to 1
  double close = -1.0;    ///< [m] holes whose points are this near to their rim are closed; below
                          ///< 0: as `error`
  Engine engine = Engine::automatic;  ///< what divides it
  /// Progress callback, for people; may be empty.
  std::function<void(const std::string&)> progress{};
};

/// A piece of the surface that is in no part.
struct Uncovered {
  std::vector<Vec3> polygon;  ///< [m]
  double depth = 0.0;         ///< [m] no point of it is farther from the nearest part
};

/// Convex parts and their proven bounds. The solid is the surface and, if that is closed, its
/// inside.
struct Cover {
  std::vector<std::vector<Vec3>> parts;  ///< [m] the corners of each part, a convex hull
  std::vector<Uncovered> uncovered;      ///< empty: every point of the surface is in a part
  /// [m] No point of the surface is farther from the parts: 1e-9 of the size of the mesh for
  /// rounding, or the largest depth in `uncovered`.
  double uncovered_m = 0.0;
  double excess_m = 0.0;          ///< [m] no point of a part is farther from the solid
  double excess_reached_m = 0.0;  ///< [m] a point of a part is this far: how tight the bound is
  double excess_mean_m = 0.0;     ///< [m] mean over the surface of all parts together, sampled
  /// [m] Depth of the seams: a point D deep in the solid is at least min(D / 2, seam) deep in one
  /// of the parts. Found by search, not proven. None if no facet is within another part.
  std::optional<double> seam_m;
  std::vector<std::string> faults;  ///< of the mesh, a sentence for each
  bool is_closed = true;            ///< the mesh
  std::string engine;               ///< that divided it
};

/// Covers `mesh`. Cost: seconds to minutes; the bounds take most of it.
/// @throws SetupError for options out of their range, a mesh without any area, with a corner beyond
///   Shape::largest or a triangle with an invalid index, or a missing engine
[[nodiscard]] Cover cover_of(const TriangleMesh& mesh, const CoverOptions& options);

/// The bounds of parts that come from elsewhere: fills in a Cover for the hulls of `parts`.
/// @throws SetupError as cover_of
[[nodiscard]] Cover checked_cover(const TriangleMesh& mesh,
                                  const std::vector<std::vector<Vec3>>& parts,
                                  const CoverOptions& options);

/// Whether the library of CoACD is found here.
[[nodiscard]] bool has_coacd();

/// Whether HACD is built in.
[[nodiscard]] bool has_hacd();

}  // namespace repel::cover
