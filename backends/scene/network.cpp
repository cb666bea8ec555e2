#include "network.hpp"

#include <algorithm>
#include <set>

#include <repel/base/setup_error.hpp>

namespace repel::scene {
namespace {

using Options = decltype(Module::options);
using Keys = std::initializer_list<std::string_view>;

/// The map of one entry, with the keys that every module has and those of this one.
void allow(const Map& map, Keys keys) {
  std::vector<std::string_view> all{"module", "name", "to"};
  all.insert(all.end(), keys.begin(), keys.end());
  map.allow(all);
}

Options torque_arm_of(const Map& map) {
  allow(map, {"inertia", "friction", "hand_stiffness", "hand_damping", "torque_limit"});
  network::TorqueArmOptions options;
  map.read("inertia", {unit::inertia, 1e-6, 1e3}, options.inertia);
  map.read("friction", {unit::angular_damping, 0.0, 1e3}, options.friction);
  map.read("hand_stiffness", {unit::angular_stiffness, 0.0, 1e5}, options.hand_stiffness);
  map.read("hand_damping", {unit::angular_damping, 0.0, 1e4}, options.hand_damping);
  map.read("torque_limit", {unit::torque, 0.0, 1e4}, options.torque_limit);
  return options;
}

Options multiplex_of(const Map& map) {
  allow(map, {"velocity_scale", "force_scale", "turning_time"});
  network::MultiplexOptions options;
  map.read("velocity_scale", {unit::length_per_angle, 1e-6, 100.0}, options.velocity_scale);
  options.force_scale = options.velocity_scale;  // lossless unless the file says otherwise
  map.read("force_scale", {unit::length, 1e-6, 100.0}, options.force_scale);
  map.read("turning_time", {unit::time, 0.0, 100.0}, options.turning_time);
  return options;
}

Options spaceball_of(const Map& map) {
  allow(map,
        {"dead_band", "saturation", "angular_dead_band", "angular_saturation", "time_constant"});
  network::SpaceballOptions options;
  map.read("dead_band", {unit::speed, 0.0, 10.0}, options.dead_band);
  map.read("saturation", {unit::speed, 0.0, 10.0}, options.saturation);
  map.read("angular_dead_band", {unit::angular_speed, 0.0, 100.0}, options.angular_dead_band);
  map.read("angular_saturation", {unit::angular_speed, 0.0, 100.0}, options.angular_saturation);
  map.read("time_constant", {unit::time, 0.0, 100.0}, options.time_constant);
  return options;
}

Options relief_of(const Map& map) {
  allow(map,
        {"compliant", "frame", "stiffness", "damping", "angular_stiffness", "angular_damping"});
  network::ReliefOptions options;
  constexpr std::string_view words[] = {"x", "y", "z", "rx", "ry", "rz"};
  if (const Value* list = map.find("compliant")) {
    for (const Value& entry : list->list()) {
      const std::string word = entry.word_of({"x", "y", "z", "rx", "ry", "rz"});
      options.compliant[std::find(std::begin(words), std::end(words), word) - words] = true;
    }
  }
  if (const Value* frame = map.find("frame")) {
    const bool world = frame->word_of({"world", "tool"}) == "world";
    options.frame = world ? network::ReliefFrame::world : network::ReliefFrame::tool;
  }
  map.read("stiffness", {unit::stiffness, 0.0, 1e7}, options.stiffness);
  map.read("damping", {unit::damping, 0.0, 1e6}, options.damping);
  map.read("angular_stiffness", {unit::angular_stiffness, 0.0, 1e6}, options.angular_stiffness);
  map.read("angular_damping", {unit::angular_damping, 0.0, 1e6}, options.angular_damping);
  return options;
}

Options kbb2_of(const Map& map) {
  allow(map, {"stiffness", "damping", "shunt", "force_limit", "angular_stiffness",
              "angular_damping", "angular_shunt", "torque_limit"});
  network::Kbb2Options options;
  map.read("stiffness", {unit::stiffness, 1e-3, 1e7}, options.stiffness);
  map.read("damping", {unit::damping, 0.0, 1e6}, options.damping);
  map.read("shunt", {unit::damping, 0.0, 1e6}, options.shunt);
  map.read("force_limit", {unit::force, 0.0, 1e6}, options.force_limit);
  map.read("angular_stiffness", {unit::angular_stiffness, 1e-3, 1e6}, options.angular_stiffness);
  map.read("angular_damping", {unit::angular_damping, 0.0, 1e6}, options.angular_damping);
  map.read("angular_shunt", {unit::angular_damping, 0.0, 1e6}, options.angular_shunt);
  map.read("torque_limit", {unit::torque, 0.0, 1e6}, options.torque_limit);
  return options;
}

Options arm_obstacle_of(const Map& map) {
  allow(map, {"most_energy", "most_damping"});
  network::ArmObstacleOptions options;
  map.read("most_energy", {unit::energy, 0.0, 1e6}, options.most_energy);
  map.read("most_damping", {unit::angular_damping, 0.0, 1e6}, options.most_damping);
  return options;
}

Options obstacle_of(const Map& map, Network& network) {
  allow(map, {"gain_check", "most_energy", "most_damping"});
  network::ObstacleOptions options;
  map.read("most_energy", {unit::energy, 0.0, 1e6}, options.passivity.most_energy);
  map.read("most_damping", {unit::damping, 0.0, 1e6}, options.passivity.most_damping);
  if (const Value* check = map.find("gain_check")) {
    const bool warn = check->word_of({"error", "warning"}) == "warning";
    network.gain_check = warn ? network::GainCheck::warning : network::GainCheck::error;
  }
  return options;
}

Options limits_of(const Map& map) {
  allow(map, {"range", "stiffness", "damping"});
  network::JointLimits law;
  map.read("range", {unit::angle, 1e-6, 1e3}, law.range);
  map.read("stiffness", {unit::angular_stiffness, 0.0, 1e6}, law.stiffness);
  map.read("damping", {unit::angular_damping, 0.0, 1e6}, law.damping);
  return law;
}

Options line_of(const Map& map) {
  allow(map,
        {"kind", "impedance", "angular_impedance", "delay", "jitter", "loss", "seed", "buffer"});
  network::LineOptions options;
  if (const Value* kind = map.find("kind")) {
    const bool waves = kind->word_of({"waves", "force_velocity"}) == "waves";
    options.kind = waves ? network::LineKind::waves : network::LineKind::force_velocity;
  }
  map.read("impedance", {unit::damping, 1e-6, 1e6}, options.impedance);
  map.read("angular_impedance", {unit::angular_damping, 1e-6, 1e6}, options.angular_impedance);
  map.read("delay", {unit::time, 0.0, 10.0}, options.channel.delay);
  map.read("jitter", {unit::time, 0.0, 10.0}, options.channel.jitter);
  map.read("buffer", {unit::time, 0.0, 10.0}, options.buffer);
  map.read("loss", {unit::share, 0.0, 1.0}, options.channel.loss);
  if (const Value* seed = map.find("seed")) {
    options.channel.seed = static_cast<std::uint64_t>(seed->integer(0, 1'000'000'000));
  }
  return options;
}

Options element_of(const Map& map, Element::Kind kind) {
  const bool mass = kind == Element::Kind::mass;
  const bool spring = kind == Element::Kind::spring;
  const std::string_view linear = mass ? "mass" : spring ? "stiffness" : "damping";
  const std::string_view angular = mass     ? "inertia"
                                   : spring ? "angular_stiffness"
                                            : "angular_damping";
  Element element{.kind = kind};
  allow(map, {"space", linear, angular});
  if (const Value* space = map.find("space")) {
    const bool lever = space->word_of({"tool", "lever"}) == "lever";
    element.space = lever ? network::Space::lever : network::Space::tool;
  }
  const bool tool = element.space == network::Space::tool;
  if (!tool) allow(map, {"space", angular});
  const auto pick = [&](Units of_mass, Units of_spring, Units of_damper) {
    return mass ? of_mass : spring ? of_spring : of_damper;
  };
  const Units linear_units = pick(unit::mass, unit::stiffness, unit::damping);
  const Units angular_units = pick(unit::inertia, unit::angular_stiffness, unit::angular_damping);
  if (tool) element.linear = map.at(linear).number({linear_units, 1e-9, 1e7});
  element.angular = map.at(angular).number({angular_units, 1e-9, 1e7});
  return element;
}

Options junction_of(const Map& map) {
  allow(map, {"common"});
  const Value* common = map.find("common");
  const bool effort = common && common->word_of({"flow", "effort"}) == "effort";
  return effort ? network::Common::effort : network::Common::flow;
}

Options plain_of(const Map& map, Options options) {
  allow(map, {});
  return options;
}

Options options_of(const std::string& word, const Map& map, Network& network) {
  if (word == "torque_arm") return torque_arm_of(map);
  if (word == "multiplex") return multiplex_of(map);
  if (word == "spaceball") return spaceball_of(map);
  if (word == "relief") return relief_of(map);
  if (word == "kbb2") return kbb2_of(map);
  if (word == "obstacle") return obstacle_of(map, network);
  if (word == "arm_obstacle") return arm_obstacle_of(map);
  if (word == "puma_kin") return plain_of(map, Kinematic{});
  if (word == "limits") return limits_of(map);
  if (word == "visual") return plain_of(map, Tap{});
  if (word == "puma_joints") return plain_of(map, Joints{});
  if (word == "ground") return plain_of(map, Ground{});
  if (word == "line") return line_of(map);
  if (word == "spring") return element_of(map, Element::Kind::spring);
  if (word == "damper") return element_of(map, Element::Kind::damper);
  if (word == "mass") return element_of(map, Element::Kind::mass);
  return junction_of(map);
}

Module module_of(const Value& value, Network& network) {
  const Map map(value);
  const Value& kind = map.at("module");
  const std::string word =
      kind.word_of({"torque_arm", "multiplex", "spaceball", "relief", "kbb2", "obstacle",
                    "puma_kin", "arm_obstacle", "limits", "visual", "puma_joints", "ground", "line",
                    "junction", "spring", "damper", "mass"});
  Module module{word, {}, options_of(word, map, network), value.line()};
  map.read("name", module.name);
  if (const Value* to = map.find("to")) {
    module.to.next = false;
    if (to->is_list()) {
      for (const Value& name : to->list(input_limits.modules))
        module.to.names.push_back(name.text());
    } else {
      module.to.names.push_back(to->text());
    }
  }
  return module;
}

/// The module itself, with what is known of the arm.
struct Maker {
  const ArmModel& arm;

  network::Module operator()(const network::TorqueArmOptions& o) const {
    return network::TorqueArm(o);
  }
  network::Module operator()(const network::MultiplexOptions& o) const {
    return network::Multiplex(o);
  }
  network::Module operator()(const network::SpaceballOptions& o) const {
    return network::Spaceball(o);
  }
  network::Module operator()(const network::ReliefOptions& o) const { return network::Relief(o); }
  network::Module operator()(const network::Kbb2Options& o) const { return network::Kbb2(o); }
  network::Module operator()(const network::ObstacleOptions& o) const {
    return network::Obstacle(o);
  }
  network::Module operator()(const network::ArmObstacleOptions& o) const {
    return network::ArmObstacle(o);
  }
  network::Module operator()(const Kinematic& /*none*/) const { return network::PumaKin(); }
  network::Module operator()(const network::JointLimits& law) const {
    std::vector<network::JointRange> ranges;
    for (const ArmLink& link : arm.links) ranges.push_back({link.lower, link.upper});
    return network::Limits(law, ranges);
  }
  network::Module operator()(const Tap& /*none*/) const { return network::Visual(); }
  network::Module operator()(const Joints& /*none*/) const {
    return network::PumaJoints(static_cast<int>(arm.links.size()));
  }
  network::Module operator()(const Ground& /*none*/) const {
    return network::FlowSource<network::any_size>(network::Vec<network::any_size>::Zero(6));
  }
  network::Module operator()(network::Common common) const { return network::Junction(common); }
  network::Module operator()(const network::LineOptions& o) const { return network::Line(o); }
  network::Module operator()(const Element& e) const {
    using network::any_size;
    const int size = e.space == network::Space::tool ? 6 : 1;
    network::Mat<any_size> gain = network::Mat<any_size>::Identity(size, size) * e.angular;
    if (size == 6) gain.topLeftCorner<3, 3>() = e.linear * Mat3::Identity();
    if (e.kind == Element::Kind::spring) return network::Spring<any_size>(gain);
    if (e.kind == Element::Kind::mass) return network::Mass<any_size>(gain);
    return network::Damper<any_size>(gain);
  }
};

/// Line of the module that is named first in `text`; 0 when none is.
int line_of_named(const std::vector<Module>& modules, const std::string& text) {
  std::size_t first = std::string::npos;
  int line = 0;
  for (const Module& module : modules) {
    const std::size_t at = text.find("'" + module.name + "'");
    if (at >= first) continue;
    first = at;
    line = module.line;
  }
  return line;
}

}  // namespace

Network detail::network_of(const Value* value) {
  Network network;
  if (value == nullptr) {
    network.modules = {{"torque_arm", {}, network::TorqueArmOptions{}},
                       {"multiplex", {}, network::MultiplexOptions{}},
                       {"spaceball", {}, network::SpaceballOptions{}},
                       {"relief", {}, network::ReliefOptions{}},
                       {"kbb2", {}, network::Kbb2Options{}},
                       {"obstacle", {}, network::ObstacleOptions{}},
                       {"puma_kin", {}, Kinematic{}},
                       {"arm_obstacle", {}, network::ArmObstacleOptions{}},
                       {"limits", {}, network::JointLimits{}},
                       {"visual", {}, Tap{}},
                       {"puma_joints", {}, Joints{}}};
    return network;
  }
  for (const Value& entry : value->list(input_limits.modules)) {
    network.modules.push_back(module_of(entry, network));
  }
  if (network.modules.empty()) value->fail("'network' has no module; allowed: 1 or more");
  return network;
}

bool feels_links(const Station& station) {
  const auto& modules = station.network.modules;
  return std::any_of(modules.begin(), modules.end(), [](const Module& m) {
    return std::holds_alternative<network::ArmObstacleOptions>(m.options);
  });
}

network::Network build_network(const Scene& scene, const Station& station, const ArmModel& arm,
                               double rate_hz) {
  const auto& modules = station.network.modules;
  const bool felt = std::any_of(modules.begin(), modules.end(), [](const Module& m) {
    return std::holds_alternative<network::ObstacleOptions>(m.options);
  });
  if (!(scene.obstacles.empty() && scene.partners.empty()) && !felt) {
    throw SetupError("network: there are obstacles and no module 'obstacle' through which they act",
                     scene.file);
  }
  const auto& links = station.robot.links;
  if (links && !links->empty() && !feels_links(station)) {
    throw SetupError(
        "robot: there are links to keep off the obstacles and no module 'arm_obstacle' in the "
        "network through which they feel them",
        scene.file);
  }
  network::Plan plan;
  try {
    for (const Module& module : modules) {
      plan.add(module.name, std::visit(Maker{arm}, module.options), module.to);
    }
    return plan.build(1.0 / rate_hz);
  } catch (const SetupError& error) {
    const std::string what = std::string("network: ") + error.what();
    throw SetupError(what, scene.file, line_of_named(modules, what));
  }
}

}  // namespace repel::scene
