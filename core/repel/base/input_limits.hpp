/// @file
/// How much a file may ask of the machine that reads it, in one place.
#pragma once

#include <cstddef>

namespace repel {

/// The most that scene files, robot descriptions and recordings may hold. More is refused with
/// SetupError before it is read, or before it costs more than what is allowed does. What a world
/// may hold stands in Limits.
struct InputLimits {
  std::size_t file_bytes = std::size_t{16} << 20;  ///< [byte] of a scene, URDF or SRDF file
  std::size_t text_bytes = 4096;                   ///< [byte] of one name, path or row of numbers
  std::size_t depth = 32;                          ///< lists and maps of a scene in each other
  std::size_t values = 500'000;       ///< of a scene: texts, lists and maps, aliases written out
  std::size_t entries = 10'000;       ///< of one list or map; collisions of a robot
  std::size_t modules = 256;          ///< of the network of one arm
  std::size_t attributes = 64;        ///< of one element of a URDF file
  std::size_t directives = 16;        ///< lines of a scene that begin with %
  std::size_t hull_points = 100'000;  ///< of all hulls of a scene; corners of all meshes of a robot
  std::size_t mesh_bytes = std::size_t{256} << 20;  ///< [byte] of all mesh files of a robot
  std::size_t mesh_vertices = 2'000'000;            ///< of one mesh file
  std::size_t meshes = 1000;  ///< mesh files that one robot names, one as often as it is named
  int mesh_seconds = 60;      ///< [s] of processor time for one mesh file, small files less
  std::size_t mesh_memory = std::size_t{2}
                            << 30;  ///< [byte] to read one mesh file, small files less
  std::size_t message_bytes = std::size_t{4} << 20;  ///< [byte] of one message of a recording
};

/// Those that hold.
inline constexpr InputLimits input_limits;

}  // namespace repel
