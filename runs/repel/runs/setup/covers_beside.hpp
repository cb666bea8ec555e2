// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The covers of the meshes of robot descriptions, from the lists of parts beside them.
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include <repel/robots/robot.hpp>
#include <repel/scene/part_list.hpp>

namespace repel::runs {

/// Reads them, and keeps what is told of them.
class CoversBeside {
 public:
  /// For UrdfOptions::convex_parts, as long as this object exists.
  [[nodiscard]] ConvexParts reader() {
    return [this](const std::string& mesh, const Vec3& scale) {
      scene::PartList list = scene::list_beside(mesh, scale, lists_);
      gaps_[key(mesh, scale)] = std::move(list.gaps);
      return std::move(list.parts);
    };
  }

  /// The gaps of the mesh of `part`, in the frame of the part, if it is the first part of a cover
  /// read here; otherwise none.
  [[nodiscard]] scene::Gaps gaps_of(const RobotPart& part) const {
    const auto found = gaps_.find(key(part.mesh, part.mesh_scale));
    const bool is_first = part.is_of_cover && part.name.ends_with("/1");
    return is_first && found != gaps_.end() ? found->second : scene::Gaps{};
  }

  /// Paths of the lists that were read.
  [[nodiscard]] const std::vector<std::string>& lists() const { return lists_; }

 private:
  using Key = std::pair<std::string, std::array<double, 3>>;

  static Key key(const std::string& mesh, const Vec3& scale) {
    return {mesh, {scale.x(), scale.y(), scale.z()}};
  }

  std::vector<std::string> lists_;
  std::map<Key, scene::Gaps> gaps_;
};

}  // namespace repel::runs
