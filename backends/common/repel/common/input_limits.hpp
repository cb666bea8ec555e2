// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Limits on the size and cost of input files.
#pragma once

#include <cstddef>

namespace repel {

/// Largest accepted scene files, robot descriptions and recordings. Larger input is refused with
/// SetupError before it is read, or before it costs more than the largest allowed input. For the
/// capacities of a world see Capacities.
struct InputLimits {
  std::size_t file_bytes = std::size_t{16} << 20;  ///< [byte] of a scene, URDF or SRDF file
  std::size_t text_bytes = 4096;                   ///< [byte] of one name, path or row of numbers
  std::size_t depth = 32;        ///< nesting depth of the lists and maps of a scene
  std::size_t values = 500'000;  ///< of a scene: scalars, lists and maps, with aliases expanded
  std::size_t entries = 10'000;  ///< of one list or map; collisions of a robot
  std::size_t modules = 256;     ///< in the network of one arm
  std::size_t attributes = 64;   ///< of one URDF element
  std::size_t directives = 16;   ///< lines of a scene that start with %
  /// Of all hulls of a scene; vertices of all meshes of a robot
  std::size_t hull_points = 100'000;
  std::size_t mesh_bytes = std::size_t{256} << 20;  ///< [byte] of all mesh files of a robot
  std::size_t mesh_vertices = 2'000'000;            ///< different ones, of one mesh file
  std::size_t mesh_triangles = 4'000'000;           ///< of one mesh file
  std::size_t meshes = 1000;  ///< different mesh files of one robot; a file counts once per scale
  int mesh_seconds = 60;      ///< [s] of processor time for one mesh file; less for small files
  /// [byte] To read one mesh file; less for small files
  std::size_t mesh_memory = std::size_t{2} << 30;
  std::size_t message_bytes = std::size_t{4} << 20;  ///< [byte] of one message of a recording
};

/// The limits in force.
inline constexpr InputLimits input_limits;

}  // namespace repel
