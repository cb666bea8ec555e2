// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Files with the convex parts of a mesh: the program `cover` writes them, scenes read them.
#pragma once

#include <cstddef>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include <repel/base/types.hpp>

namespace repel::scene {

/// A piece of the surface of a mesh that lies in no part.
struct Gap {
  Vec3 p_M{0, 0, 0};   ///< [m] a point of it
  double depth = 0.0;  ///< [m] no point of it is farther from the parts
};

/// Such pieces.
struct Gaps {
  static constexpr std::size_t most_kept = 100;  ///< of one mesh

  std::size_t count = 0;     ///< of all
  std::vector<Gap> deepest;  ///< the deepest ones, the deepest first, at most `most_kept`
};

/// The parts of a mesh, and what was proven of them when they were made.
struct PartList {
  std::string mesh;            ///< name of the mesh file, without its folder
  std::string checksum;        ///< of the mesh file, see checksum_of_file(); empty: not known
  Vec3 scale{1, 1, 1};         ///< factors that the vertices of the mesh were multiplied by
  double uncovered = 0.0;      ///< [m] no point of the surface is farther from the parts
  double excess = 0.0;         ///< [m] no point of the parts is farther from the mesh
  std::optional<double> seam;  ///< [m] depth up to which an intrusion feels one part
  std::vector<std::vector<Vec3>> parts;  ///< [m] corners of convex hulls
  Gaps gaps;                             ///< where the mesh is in none of them
};

/// Where the parts of a mesh file are unless said otherwise: beside it.
[[nodiscard]] inline std::string part_list_beside(const std::string& mesh) {
  return mesh + ".parts.yaml";
}

/// Writes `list` as YAML that reads back exactly; scenes/README.md describes it.
void write_part_list(const PartList& list, std::ostream& out);

/// Reads a file that write_part_list() wrote, or one like it.
/// @throws SetupError naming file, line, value and what is allowed
[[nodiscard]] PartList read_part_list(const std::string& path);

/// The list at `path` of the convex parts of the file `mesh`.
/// @throws SetupError as read_part_list(), and without line if it has no part or is of another
///   version of the mesh, with the command that makes it anew
[[nodiscard]] PartList part_list_of(const std::string& mesh, const std::string& path);

/// The list beside the file `mesh`, converted to its vertices multiplied by `scale`; without parts
/// if there is no list.
/// @param lists to which the path of the list is added, unless it is there
/// @throws SetupError as part_list_of(), or if the list or `scale` has a factor of 0
[[nodiscard]] PartList list_beside(const std::string& mesh, const Vec3& scale,
                                   std::vector<std::string>& lists);

/// The parts of list_beside() [m].
[[nodiscard]] std::vector<std::vector<Vec3>> parts_beside(const std::string& mesh,
                                                          const Vec3& scale,
                                                          std::vector<std::string>& lists);

/// The FNV-1a hash of the bytes of a file, as 16 hexadecimal digits: it tells that a file has
/// changed, not that someone meant to hide it.
/// @throws SetupError if the file cannot be read
[[nodiscard]] std::string checksum_of_file(const std::string& path);

}  // namespace repel::scene
