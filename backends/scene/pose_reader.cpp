// SPDX-License-Identifier: BSD-3-Clause
#include "pose_reader.hpp"

namespace repel::scene {

Mat3 detail::rotation_of(const Vec3& rpy) {
  return (Eigen::AngleAxisd(rpy.z(), Vec3::UnitZ()) * Eigen::AngleAxisd(rpy.y(), Vec3::UnitY()) *
          Eigen::AngleAxisd(rpy.x(), Vec3::UnitX()))
      .toRotationMatrix();
}

Pose detail::pose_of(const Map& map) {
  Vec3 p = Vec3::Zero();
  Vec3 rpy = Vec3::Zero();
  map.read("position", p);
  map.read("rpy", rpy);
  Pose X = Pose::Identity();
  X.translation() = p;
  X.linear() = rotation_of(rpy);
  return X;
}

}  // namespace repel::scene
