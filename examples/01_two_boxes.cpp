// SPDX-License-Identifier: BSD-3-Clause
// Two boxes: how far apart they are, and the force that keeps them there.
#include <cstdio>

#include <repel/repel.hpp>

int main() {
  using namespace repel;
  const Shape tool = Shape::box({0.05, 0.05, 0.10});  // half extents [m]
  const Shape table = Shape::box({0.60, 0.40, 0.02});
  const ForceLaw wall{.range = 0.02, .surface_force = 100.0, .damping = 50.0};

  Pose X_WTool = Pose::Identity();
  const Pose X_WTable = Pose::Identity();
  WarmStart warm;  // what one query leaves for the next
  for (const double height : {0.150, 0.135, 0.125, 0.119, 0.100}) {
    X_WTool.translation() = Vec3(0.1, 0.0, height);
    const Separation s = separation(tool, X_WTool, table, X_WTable, {}, warm);
    const double force = wall(s.distance, 0.0);    // at rest
    const Vec3 n = s.extraction_W + Vec3::Zero();  // a zero prints without its sign
    std::printf("tool at %.3f m: distance %+.3f m, way out (%.0f %.0f %.0f), force %.2f N\n",
                height, s.distance, n.x(), n.y(), n.z(), force);
  }
  return 0;
}
