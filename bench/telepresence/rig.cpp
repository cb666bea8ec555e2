// SPDX-License-Identifier: BSD-3-Clause
#include "rig.hpp"

#include <cmath>

namespace repel::telepresence {

namespace {

using namespace network;

Network build(const RigOptions& o) {
  Plan plan;
  plan.add("hand", TorqueArm({.inertia = RigOptions::hand_mass,
                              .friction = 0.0,
                              .hand_stiffness = RigOptions::hand_stiffness,
                              .hand_damping = RigOptions::hand_damping,
                              .torque_limit = RigOptions::force_limit}));
  plan.add("multiplex", Multiplex({.velocity_scale = 1.0, .force_scale = 1.0}));
  Kbb2Options coupling{
      .stiffness = 4000.0, .damping = 80.0, .force_limit = RigOptions::force_limit};
  if (o.way != Way::direct) {
    coupling.shunt = RigOptions::line_impedance;
    plan.add("line", Line({.kind = o.way == Way::waves ? LineKind::waves : LineKind::force_velocity,
                           .impedance = RigOptions::line_impedance,

                           .channel = o.channel,
                           .buffer = o.buffer}));
  }
  plan.add("kbb2", Kbb2(coupling)).add("obstacle", Obstacle()).add("puma_kin", PumaKin());
  return plan.add("puma_joints", PumaJoints(1)).build(1.0 / o.rate_hz);
}

}  // namespace

const char* name_of(Way way) {
  return way == Way::direct ? "direct" : way == Way::waves ? "waves" : "plain";
}

ForceLaw stiff_wall(double stiffness, double damping) {
  return {.range = 2.0 / stiffness, .surface_force = 1.0, .damping = damping};
}

Rig::Rig(const RigOptions& options)
    : options_(options),
      network_(build(options)),
      signals_(network::detail::neutral_signals(1, 1.0 / options.rate_hz)),
      slider_(options.slider, 1.0 / options.rate_hz) {}

Sample Rig::tick(double hand_speed) {
  const double grain = options_.resolution;
  const double x = slider_.position();
  signals_.joints(0) = grain > 0.0 ? grain * std::round(x / grain) : x;
  signals_.X_WT.translation().x() = signals_.joints(0);
  const Vec<any_size> rate = Vec<any_size>::Constant(1, slider_.speed());
  flow_.step(signals_.joints, rate, signals_.period);
  signals_.rates = flow_.flow();
  signals_.mean_rates = flow_.mean();
  signals_.walls.force.x() = -options_.wall(options_.wall_at - signals_.joints(0), -rate(0));
  signals_.hand.lever_rate = hand_speed;
  sound_ = network_.run(signals_) && sound_;
  const double torque = network_.find<PumaJoints>()->torques()(0);
  sound_ = sound_ && std::isfinite(torque);
  slider_.move(torque);
  const TorqueArm& lever = *network_.find<TorqueArm>();
  return {lever.angle(),
          lever.rate(),
          -lever.felt(),
          x,
          -network_.find<Obstacle>()->on_tool().force.x(),
          torque};
}

double Rig::buffer() const {
  if (options_.way != Way::waves) return 0.0;
  if (options_.buffer >= 0.0) return options_.buffer;
  return options_.channel.jitter + 2.0 * signals_.period;
}

double Rig::transit() const {
  if (options_.way == Way::direct) return 0.0;
  return std::max(options_.channel.delay, signals_.period) + buffer();
}

double Rig::least_of_line() const {
  const Node* line = network_.node_of<Line>();
  return line == nullptr ? 0.0 : line->ledger.least;
}

std::string Rig::complaint() const {
  if (!sound_) return "a tick was not solved, or a force is not finite";
  for (const Node& node : network_.nodes()) {
    if (!std::isfinite(node.ledger.energy)) return "the energy of " + node.name + " is not finite";
    if (node.traits.passive && node.ledger.deficit() > 1e-9) {
      return node.name + " gave " + to_text(-node.ledger.least) + " J more than it took";
    }
  }
  return {};
}

}  // namespace repel::telepresence
