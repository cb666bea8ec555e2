// SPDX-License-Identifier: BSD-3-Clause
#include <repel/cell/workspace.hpp>

#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

namespace repel::detail {

void draw_pose(const ArmDescription& arm, int index, std::vector<double>& q) {
  constexpr double pi = std::numbers::pi;
  const std::vector<ArmLink>& links = arm.model.links;
  double root = 2.0;
  for (int i = 0; i < 50; ++i) {
    root = std::pow(1.0 + root, 1.0 / (static_cast<double>(links.size()) + 1.0));
  }
  double step = 1.0;
  for (std::size_t i = 0; i < links.size(); ++i) {
    step /= root;
    double lower = links[i].lower;
    double upper = links[i].upper;
    if (links[i].type == JointType::revolute && !(upper - lower <= 2.0 * pi)) {
      lower = -pi;
      upper = pi;
    }
    const double share = 0.5 + (index + 1) * step;
    const double drawn = lower + (share - std::floor(share)) * (upper - lower);
    q[i] = drawn - drawn == 0.0 ? drawn : arm.start[i];
  }
}

}  // namespace repel::detail
