// SPDX-License-Identifier: BSD-3-Clause
// A lever drives a slider into a wall 20 mm away through a channel with 50 ms delay. Prints the
// torque that the operator feels at the lever.
#include <cstdio>

#include <repel/control.hpp>
#include <repel/repel.hpp>

int main() {
  using namespace repel;
  using namespace repel::network;
  constexpr double period = 0.001;  // [s]
  LineOptions line;
  line.channel.delay = 0.05;  // [s]
  line.impedance = 100.0;     // [N s/m]
  Kbb2Options coupling;
  coupling.damping = line.impedance;  // matches the wave impedance of the line
  Network network = Plan()
                        .add("torque_arm", TorqueArm())
                        .add("multiplex", Multiplex())
                        .add("line", Line(line))
                        .add("kbb2", Kbb2(coupling))
                        .add("obstacle", Obstacle())
                        .add("puma_kin", PumaKin())
                        .add("puma_joints", PumaJoints(1))
                        .build(period);

  const ForceLaw wall{.range = 0.01, .surface_force = 50.0, .damping = 20.0};
  constexpr double mass = 2.0;  // [kg] of the slider, which moves along x
  double x = 0.0;               // [m]
  double v = 0.0;               // [m/s]
  Signals signals;
  signals.period = period;
  signals.jacobian.setZero(6, 1);
  signals.jacobian(0, 0) = 1.0;
  for (int tick = 0; tick < 2000; ++tick) {
    signals.joints.setConstant(1, x);
    signals.rates.setConstant(1, v);
    signals.mean_rates = signals.rates;
    signals.X_WT.translation().x() = x;
    signals.walls.force.x() = -wall(0.02 - x, -v);
    signals.hand.lever_rate = tick < 500 ? 0.8 : 0.0;  // [rad/s], 0.1 m of tool per radian
    if (!network.run(signals)) return 1;
    if (tick % 200 == 0) {
      std::printf("%4.1f s: slider at %4.1f mm, wall %5.1f N, hand feels %5.2f N m\n",
                  tick * period, 1e3 * x, -signals.walls.force.x(),
                  network.find<TorqueArm>()->felt());
    }
    v += period / mass * network.find<PumaJoints>()->torques()(0);
    x += period * v;
  }
  for (const Node& node : network.nodes()) {
    std::printf("%-12s %7.4f J stored or dissipated of %7.4f J passed\n", node.name.c_str(),
                node.ledger.energy, node.ledger.passed);
  }
  return 0;
}
