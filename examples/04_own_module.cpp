// SPDX-License-Identifier: BSD-3-Clause
// A custom network module: viscous drag on the tool below z = 0.5 m, as in a pool of honey. It is
// used in a network built here, and in one that a scene file describes by module name.
#include <cstdio>

#include <repel/control.hpp>
#include <repel/repel.hpp>
#include <repel/scene/build_network.hpp>
#include <repel/scene/scene.hpp>

using namespace repel::network;
namespace scene = repel::scene;

class Honey {
 public:
  static constexpr Traits traits{.left = Space::tool, .right = Space::tool, .keeps_flow = true};

  explicit Honey(double damping) : damping_(damping) {}  // [N s/m]

  void read(const Signals& signals) noexcept {  // the pose of this tick
    const double depth = 0.5 - signals.X_WT.translation().z();
    drag_.diagonal().head<3>().setConstant(depth > 0.0 ? damping_ : 0.0);
  }
  // Towards the root (the robot): the equivalent of the subtree behind, plus the drag impedance.
  bool reflected(const Equivalent<any_size>& behind, Equivalent<any_size>& shown) noexcept {
    shown = behind;
    shown.add_impedance(drag_, Vec<any_size>::Zero(6));
    return true;
  }
  // Back towards the leaves: the flow of the root; the drag has taken its share of the effort.
  void incident(const PortState<any_size>& at_root, const Equivalent<any_size>& /*behind*/,
                PortState<any_size>& at_leaf) noexcept {
    at_leaf.flow = at_root.flow;
    at_leaf.effort = at_root.effort - drag_ * at_root.flow;
  }

 private:
  double damping_;
  Mat<any_size> drag_ = Mat<any_size>::Zero(6, 6);
};

// Three sliding joints of 2 kg and three rotating ones of 0.1 kg m^2; the operator commands 50 mm/s
// downwards. Returns the descent after one second [m].
double depth_after_a_second(Network network, double period) {
  constexpr double mass[] = {2.0, 2.0, 2.0, 0.1, 0.1, 0.1};
  Signals s;
  s.period = period;
  s.joints = s.rates = s.mean_rates = Vec<any_size>::Zero(6);
  s.jacobian.setIdentity(6, 6);
  s.hand.ball.linear.z() = -0.05;
  for (int tick = 0; tick < 1.0 / period; ++tick) {
    s.X_WT.translation().z() = 0.52 + s.joints.z();
    if (!network.run(s)) return 0.0;
    for (int i = 0; i < 6; ++i) {
      s.rates(i) += period / mass[i] * network.find<PumaJoints>()->torques()(i);
    }
    s.joints += period * s.rates;
    s.mean_rates = s.rates;
  }
  return -s.joints.z();
}

constexpr const char* scene_text = R"(
robot: {urdf: robots/puma560.urdf, start: 0 45 180 0 45 0 deg}
tool: [{name: probe, shape: sphere, radius: 20 mm}]
obstacles: []
network:
  - {module: ground}
  - {module: spaceball}
  - {module: kbb2}
  - {module: honey, damping: 2 kN s/m}
  - {module: puma_kin}
  - {module: puma_joints}
)";

int main() {
  constexpr double period = 0.001;  // [s]
  const auto network_with = [](double damping) {
    return Plan()
        .add("ground", FlowSource<any_size>(Vec<any_size>::Zero(6)))
        .add("spaceball", Spaceball())
        .add("kbb2", Kbb2())
        .add("honey", Honey(damping))
        .add("puma_kin", PumaKin())
        .add("puma_joints", PumaJoints(6))
        .build(period);
  };
  for (const double damping : {0.0, 300.0, 2000.0}) {
    std::printf("honey of %4.0f N s/m: %4.1f mm down in a second\n", damping,
                1e3 * depth_after_a_second(network_with(damping), period));
  }

  scene::ModuleKinds kinds;
  kinds.add("honey", [](const scene::ModuleEntry& entry) {
    return Honey(entry.number("damping", "N s/m", 0.0, 1e5, 100.0));
  });
  const scene::Scene scene = scene::parse(scene_text, "honey.yaml", kinds);
  repel::ArmModel arm;
  arm.links.resize(6);
  Network network = scene::build_network(scene, scene, arm, 1.0 / period);
  std::printf("the same from a scene file: %4.1f mm\n",
              1e3 * depth_after_a_second(std::move(network), period));
  return 0;
}
