// SPDX-License-Identifier: BSD-3-Clause
// A box above a table, with a law to which check.sh has added a term: prints the force of every
// tick, for single and for lane evaluation of the pair.
#include <cmath>
#include <cstdio>

#include <repel/schedule/coprocessor.hpp>

int main() {
  using namespace repel;
  World world;
  const ForceLaw law{.range = 0.02, .surface_force = 100.0, .damping = 0.0};
  const BodyId tool = world.add_body("tool", Pose::Identity());
  const PartId a = world.add_part(tool, "box", Shape::box({0.05, 0.05, 0.05}));
  const PartId b = world.add_part(World::fixed, "table", Shape::box({1.0, 1.0, 0.05}));
  world.add_pair(a, b, law);
  CoprocessorOptions options;
  options.lock_step = true;
  Coprocessor coprocessor(world, options);
  int wrong = 0;
  for (int tick = 0; tick < 20; ++tick) {
    const double distance = 0.01 - 1e-4 * tick;
    Pose X_WB = Pose::Identity();
    X_WB.translation() = Vec3(0.01 * tick, 0.0, 0.1 + distance);
    world.motion().tick = tick;
    if (!world.place(tool, X_WB, {})) return 2;
    const PairForces& forces = coprocessor.exchange();
    const double force = forces.on_body[tool.index].force.z();
    const double inward = 1.0 - distance / law.range;
    const double expected = 100.0 * inward * inward + 800.0 * inward * inward * inward;
    if (std::abs(force - expected) > 1e-6 * expected) {
      std::printf("tick %d, %.4f m: %.3f N, expected %.3f N\n", tick, distance, force, expected);
      ++wrong;
    }
  }
  return wrong == 0 ? 0 : 1;
}
