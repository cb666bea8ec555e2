// SPDX-License-Identifier: BSD-3-Clause
#include <repel/loop/arms/held_weight.hpp>

#include <cstddef>
#include <span>

#include <repel/base/spatial.hpp>
#include <repel/loop/arms/arm_bodies.hpp>

namespace repel {

void add_held_weight(const World& world, BodyId tool, const Jacobian& J, const Vec3& gravity_W,
                     Masses masses, std::span<double> torques) noexcept {
  const auto& bodies = world.motion().bodies;
  for (const detail::LoosePart& loose : world.loose()) {
    const BodyState& body = bodies[static_cast<std::size_t>(loose.body.index)];
    const bool counts = masses == Masses::all || loose.is_mass_known;
    if (!counts || body.arm != tool || !(loose.mass > 0.0)) continue;
    const double share = detail::held(body.presence).now * body.presence.there.now;
    const Vec3 p_TB_W =
        origin(body.X_WB) - origin(bodies[static_cast<std::size_t>(tool.index)].X_WB);
    const Wrench lifts = wrench_of_force(-share * loose.mass * gravity_W, p_TB_W);
    for (std::size_t joint = 0; joint < torques.size(); ++joint) {
      torques[joint] += power(lifts, column_of(J, static_cast<Eigen::Index>(joint)));
    }
  }
}

}  // namespace repel
