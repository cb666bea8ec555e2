// SPDX-License-Identifier: BSD-3-Clause
#include <repel/simulated/contact.hpp>

#include <string>

#include <repel/base/setup_error.hpp>

namespace repel {

Vec3 core_extents(const Shape& shape) noexcept {
  const Convex& core = shape.level(0).core;
  return {core.support_value({1.0, 0.0, 0.0}), core.support_value({0.0, 1.0, 0.0}),
          core.support_value({0.0, 0.0, 1.0})};
}

void require_touchable(std::span<const ContactPart> parts, const ArmModel& model) {
  const int links = static_cast<int>(model.links.size());
  for (const ContactPart& part : parts) {
    const std::string whose = "part '" + part.name + "': ";
    if (part.link < -1 || part.link >= links) {
      throw SetupError(whose + "link is " + std::to_string(part.link) + "; allowed: -1 to " +
                       std::to_string(links - 1));
    }
    if (!is_finite(part.X_LP) || !is_rigid(part.X_LP)) {
      throw SetupError(whose + "X_LP is not a rigid pose");
    }
  }
}

}  // namespace repel
