// SPDX-License-Identifier: BSD-3-Clause
#include <repel/scene/module_kinds.hpp>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include <repel/base/setup_error.hpp>
#include <repel/network/modules.hpp>

#include "guide_reader.hpp"
#include "yaml.hpp"

namespace repel::scene {
namespace {

using Keys = std::initializer_list<std::string_view>;

constexpr std::string_view common_keys[] = {"module", "name", "to"};

/// Allows the keys that every module has and those of this one.
void allow(const Map& map, Keys keys) {
  std::vector<std::string_view> all(std::begin(common_keys), std::end(common_keys));
  all.insert(all.end(), keys.begin(), keys.end());
  map.allow(all);
}

/// The rule of a gain that may be left to the arm.
Rule gain(Units units, double low, double high) {
  return {.units = units, .low = low, .high = high, .may_be_auto = true};
}

template <class M, class Options>
network::Module make(const Options& options) {
  return M(options);
}

/// A module that does not depend on the arm.
template <class Options>
ReadModule made_of(const Options& options, network::Module (*from)(const Options&),
                   network::Walls walls = network::Walls::none) {
  return {options, [=](const ArmModel& /*arm*/) { return from(options); }, walls};
}

void read_hand(const Map& map, network::Hand& hand) {
  const Value* const word = map.find("hand");
  if (word == nullptr) return;
  const bool is_second = word->word_of({"first", "second"}) == "second";
  hand = is_second ? network::Hand::second : network::Hand::first;
}

ReadModule torque_arm_of(const Map& map) {
  allow(map, {"inertia", "friction", "hand_stiffness", "hand_damping", "torque_limit", "hand"});
  network::TorqueArmOptions options;
  map.read("inertia", {unit::inertia, 1e-6, 1e3}, options.inertia);
  map.read("friction", {unit::angular_damping, 0.0, 1e3}, options.friction);
  map.read("hand_stiffness", {unit::angular_stiffness, 0.0, 1e5}, options.hand_stiffness);
  map.read("hand_damping", {unit::angular_damping, 0.0, 1e4}, options.hand_damping);
  map.read("torque_limit", {unit::torque, 0.0, 1e4}, options.torque_limit);
  read_hand(map, options.hand);
  return made_of(options, make<network::TorqueArm>);
}

ReadModule six_axes_of(const Map& map) {
  allow(map, {"mass", "inertia", "friction", "angular_friction", "hand_stiffness", "hand_damping",
              "angular_hand_stiffness", "angular_hand_damping", "force_limit", "torque_limit",
              "motion_scale", "hand"});
  network::SixAxesOptions options;
  map.read("mass", {unit::mass, 1e-6, 1e3}, options.mass);
  map.read("inertia", {unit::inertia, 1e-9, 1e3}, options.inertia);
  map.read("friction", {unit::damping, 0.0, 1e4}, options.friction);
  map.read("angular_friction", {unit::angular_damping, 0.0, 1e3}, options.angular_friction);
  map.read("hand_stiffness", {unit::stiffness, 0.0, 1e6}, options.hand_stiffness);
  map.read("hand_damping", {unit::damping, 0.0, 1e5}, options.hand_damping);
  map.read("angular_hand_stiffness", {unit::angular_stiffness, 0.0, 1e5},
           options.angular_hand_stiffness);
  map.read("angular_hand_damping", {unit::angular_damping, 0.0, 1e4}, options.angular_hand_damping);
  map.read("force_limit", {unit::force, 0.0, 1e5}, options.force_limit);
  map.read("torque_limit", {unit::torque, 0.0, 1e4}, options.torque_limit);
  map.read("motion_scale", {unit::share, 1e-3, 1e3}, options.motion_scale);
  read_hand(map, options.hand);
  return made_of(options, make<network::SixAxes>);
}

ReadModule multiplex_of(const Map& map) {
  allow(map, {"velocity_scale", "force_scale", "turning_time", "hand"});
  network::MultiplexOptions options;
  map.read("velocity_scale", {unit::length_per_angle, 1e-6, 100.0}, options.velocity_scale);
  options.force_scale = options.velocity_scale;  // lossless unless the file says otherwise
  map.read("force_scale", {unit::length, 1e-6, 100.0}, options.force_scale);
  map.read("turning_time", {unit::time, 0.0, 100.0}, options.turning_time);
  read_hand(map, options.hand);
  return made_of(options, make<network::Multiplex>);
}

ReadModule spaceball_of(const Map& map) {
  allow(map,
        {"dead_band", "saturation", "angular_dead_band", "angular_saturation", "time_constant"});
  network::SpaceballOptions options;
  map.read("dead_band", {unit::speed, 0.0, 10.0}, options.dead_band);
  map.read("saturation", {unit::speed, 0.0, 10.0}, options.saturation);
  map.read("angular_dead_band", {unit::angular_speed, 0.0, 100.0}, options.angular_dead_band);
  map.read("angular_saturation", {unit::angular_speed, 0.0, 100.0}, options.angular_saturation);
  map.read("time_constant", {unit::time, 0.0, 100.0}, options.time_constant);
  return made_of(options, make<network::Spaceball>);
}

ReadModule relief_of(const Map& map) {
  allow(map,
        {"compliant", "frame", "stiffness", "damping", "angular_stiffness", "angular_damping"});
  network::ReliefOptions options;
  if (const Value* list = map.find("compliant")) {
    options.compliant = detail::directions_of(*list);
  }
  if (const Value* frame = map.find("frame")) {
    const bool world = frame->word_of({"world", "tool"}) == "world";
    options.frame = world ? network::ReliefFrame::world : network::ReliefFrame::tool;
  }
  map.read("stiffness", {unit::stiffness, 0.0, 1e7}, options.stiffness);
  map.read("damping", gain(unit::damping, 0.0, 1e6), options.damping);
  map.read("angular_stiffness", {unit::angular_stiffness, 0.0, 1e6}, options.angular_stiffness);
  map.read("angular_damping", gain(unit::angular_damping, 0.0, 1e6), options.angular_damping);
  return made_of(options, make<network::Relief>);
}

ReadModule guide_of(const Map& map) {
  std::vector<std::string_view> keys(std::begin(common_keys), std::end(common_keys));
  keys.insert(keys.end(), detail::guide_keys.begin(), detail::guide_keys.end());
  map.allow(keys);
  return made_of(detail::guide_of(map), make<network::Guide>);
}

ReadModule kbb2_of(const Map& map) {
  allow(map, {"stiffness", "damping", "shunt", "force_limit", "angular_stiffness",
              "angular_damping", "angular_shunt", "torque_limit"});
  network::Kbb2Options options;
  map.read("stiffness", gain(unit::stiffness, 1e-3, 1e7), options.stiffness);
  map.read("damping", gain(unit::damping, 0.0, 1e6), options.damping);
  map.read("shunt", {unit::damping, 0.0, 1e6}, options.shunt);
  map.read("force_limit", {unit::force, 0.0, 1e6}, options.force_limit);
  map.read("angular_stiffness", gain(unit::angular_stiffness, 1e-3, 1e6),
           options.angular_stiffness);
  map.read("angular_damping", gain(unit::angular_damping, 0.0, 1e6), options.angular_damping);
  map.read("angular_shunt", {unit::angular_damping, 0.0, 1e6}, options.angular_shunt);
  map.read("torque_limit", {unit::torque, 0.0, 1e6}, options.torque_limit);
  return made_of(options, make<network::Kbb2>);
}

ReadModule arm_obstacle_of(const Map& map) {
  allow(map, {"most_energy", "most_damping"});
  network::ArmObstacleOptions options;
  map.read("most_energy", {unit::energy, 0.0, 1e6}, options.most_energy);
  map.read("most_damping", {unit::angular_damping, 0.0, 1e6}, options.most_damping);
  return made_of(options, make<network::ArmObstacle>, network::ArmObstacle::traits.walls);
}

ReadModule force_sensor_of(const Map& map) {
  allow(map, {"gain", "cutoff", "force_range", "torque_range", "tare", "mass", "position"});
  network::ForceSensorOptions options;
  map.read("gain", {unit::share, 0.0, network::ForceSensor::most_gain}, options.gain);
  map.read("cutoff", {unit::frequency, 0.0, 1e5}, options.cutoff);
  map.read("force_range", {unit::force, 1e-3, 1e6}, options.force_range);
  map.read("torque_range", {unit::torque, 1e-3, 1e6}, options.torque_range);
  map.read("tare", {unit::time, 0.0, 100.0}, options.tare);
  map.read("mass", {unit::mass, 0.0, 1e3}, options.mass);
  map.read("position", {unit::length, -5.0, 5.0}, options.p_TC);
  return {options, [options](const ArmModel& arm) {
            network::ForceSensorOptions own = options;
            own.gravity_W = arm.gravity_W;
            return network::ForceSensor(own);
          }};
}

ReadModule obstacle_of(const Map& map) {
  allow(map, {"gain_check", "most_energy", "most_damping"});
  network::ObstacleOptions options;
  map.read("most_energy", {unit::energy, 0.0, 1e6}, options.passivity.most_energy);
  map.read("most_damping", {unit::damping, 0.0, 1e6}, options.passivity.most_damping);
  return made_of(options, make<network::Obstacle>, network::Obstacle::traits.walls);
}

/// The key `range` of the joint limits. Which kind each number has to be is known with the arm
/// only.
class LimitZones {
 public:
  explicit LimitZones(const Map& map) {
    const Value* value = map.find("range");
    if (value == nullptr) return;
    value_ = *value;
    is_list_ = value->is_list();
    entries_ = is_list_ ? value->list(network::most_joints) : std::vector<Value>{*value};
    for (const Value& entry : entries_) (void)zone(entry);
  }

  /// The range of each joint, with its zone if the file gives one.
  ///
  /// @throws SetupError for a length where a joint turns, an angle where one slides, and a list
  ///   whose number of entries is not that of the joints
  [[nodiscard]] std::vector<network::JointRange> ranges(const ArmModel& arm) const {
    if (is_list_ && entries_.size() != arm.links.size()) {
      value_->fail("'range' has " + std::to_string(entries_.size()) + " entries; allowed: " +
                   std::to_string(arm.links.size()) + ", one for each joint");
    }
    std::vector<network::JointRange> ranges;
    for (const ArmLink& link : arm.links) {
      network::JointRange& range = ranges.emplace_back();
      range = {.lower = link.lower, .upper = link.upper};
      if (!value_) continue;
      const Value& entry = entries_[is_list_ ? ranges.size() - 1 : 0];
      require_kind(entry, link);
      range.zone = zone(entry);
    }
    return ranges;
  }

 private:
  static constexpr Rule turning{unit::angle, 1e-6, 1e3};
  static constexpr Rule sliding{unit::length, 1e-6, 1e3};

  static bool is_length(const Value& entry) {
    return quantity(entry.text(), unit::length).has_value();
  }

  static double zone(const Value& entry) {
    if (is_length(entry)) return entry.number(sliding);
    if (quantity(entry.text(), unit::angle)) return entry.number(turning);
    entry.fail_with_value("1 number, then the unit " + units_text(unit::angle) +
                          " for a joint that turns, " + units_text(unit::length) +
                          " for one that slides");
  }

  static void require_kind(const Value& entry, const ArmLink& link) {
    const bool slides = link.type == JointType::prismatic;
    if (is_length(entry) == slides) return;
    entry.fail_with_value((slides ? "a length, " : "an angle, ") +
                          range_text(slides ? sliding : turning) + ", since the joint '" +
                          link.joint_name + (slides ? "' slides" : "' turns") +
                          "; a list has one entry for each joint, as in [50 mm, 5 deg]");
  }

  std::optional<Value> value_;  // empty without the key
  std::vector<Value> entries_;  // of the list, or the one for all joints
  bool is_list_ = false;
};

ReadModule limits_of(const Map& map) {
  allow(map, {"range", "stiffness", "damping"});
  network::JointLimits law;
  const LimitZones zones(map);
  map.read("stiffness", gain(unit::angular_stiffness, 0.0, 1e6), law.stiffness);
  map.read("damping", gain(unit::angular_damping, 0.0, 1e6), law.damping);
  return {law,
          [law, zones](const ArmModel& arm) { return network::Limits(law, zones.ranges(arm)); }};
}

/// @throws SetupError unless there is one position for each joint, of its kind
void require_positions(const Value& value, const std::vector<JointType>& types,
                       const ArmModel& arm) {
  if (types.size() != arm.links.size()) {
    value.fail("'joints' has " + std::to_string(types.size()) +
               " positions; allowed: " + std::to_string(arm.links.size()) + ", one for each joint");
  }
  for (std::size_t i = 0; i < types.size(); ++i) {
    const ArmLink& link = arm.links[i];
    if (link.type == types[i]) continue;
    const bool slides = link.type == JointType::prismatic;
    value.fail("'joints' has " + std::string(slides ? "an angle" : "a length") +
               " for the joint '" + link.joint_name + "'; allowed: " +
               (slides ? "a length, since it slides" : "an angle, since it turns") +
               ", as in [1 m, 0 45 deg]");
  }
}

ReadModule posture_of(const Map& map) {
  allow(map, {"stiffness", "damping", "torque_limit", "most_energy", "most_damping", "joints"});
  network::PostureOptions options;
  map.read("stiffness", {unit::angular_stiffness, 0.0, 1e6}, options.stiffness);
  map.read("damping", {unit::angular_damping, 0.0, 1e6}, options.damping);
  map.read("torque_limit", {unit::torque, 0.0, 1e6}, options.torque_limit);
  map.read("most_energy", {unit::energy, 0.0, 1e6}, options.most_energy);
  map.read("most_damping", {unit::angular_damping, 0.0, 1e6}, options.most_damping);
  const Value* const joints = map.find("joints");
  if (joints == nullptr) return made_of(options, make<network::Posture>);
  std::vector<JointType> types;
  for (const Value& entry : joints->one_or_list(network::most_joints)) {
    const bool slides = quantity(entry.text(), unit::length).has_value();
    const Rule rule{slides ? Units(unit::length) : Units(unit::angle), -1e3, 1e3};
    for (const double q : entry.numbers(rule, 1, network::most_joints)) {
      options.joints.push_back(q);
      types.push_back(slides ? JointType::prismatic : JointType::revolute);
    }
  }
  return {options, [options, types, value = *joints](const ArmModel& arm) {
            require_positions(value, types, arm);
            return network::Posture(options);
          }};
}

ReadModule line_of(const Map& map) {
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
  map.read("seed", 0, 1'000'000'000, options.channel.seed);
  return made_of(options, make<network::Line>);
}

Element element_of(const Map& map, Element::Kind kind) {
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

network::Module element_from(const Element& e) {
  using network::any_size;
  const int size = e.space == network::Space::tool ? 6 : 1;
  network::Mat<any_size> gain = network::Mat<any_size>::Identity(size, size) * e.angular;
  if (size == 6) gain.topLeftCorner<3, 3>() = e.linear * Mat3::Identity();
  if (e.kind == Element::Kind::spring) return network::Spring<any_size>(gain);
  if (e.kind == Element::Kind::mass) return network::Mass<any_size>(gain);
  return network::Damper<any_size>(gain);
}
template <Element::Kind kind>
ReadModule read_element(const Map& map) {
  return made_of(element_of(map, kind), element_from);
}

ReadModule junction_of(const Map& map) {
  allow(map, {"common"});
  const Value* common = map.find("common");
  const bool effort = common && common->word_of({"flow", "effort"}) == "effort";
  return made_of(effort ? network::Common::effort : network::Common::flow, make<network::Junction>);
}

/// A module without options.
template <class M>
ReadModule plain_of(const Map& map) {
  allow(map, {});
  return {{}, [](const ArmModel& /*arm*/) { return M(); }};
}

ReadModule ground_of(const Map& map) {
  allow(map, {});
  return {{}, [](const ArmModel& /*arm*/) { return network::Ground(); }};
}

ReadModule joints_of(const Map& map) {
  allow(map, {});
  return {{}, [](const ArmModel& arm) {
            return network::PumaJoints(static_cast<int>(arm.links.size()));
          }};
}

}  // namespace

double ModuleEntry::number(std::string_view key, std::string_view unit, double low, double high,
                           double otherwise) const {
  asked_.emplace_back(key);
  const Units units = unit::of_dimension(unit);
  map_.read(key, {units, low, high}, otherwise);
  return otherwise;
}

std::string ModuleEntry::word(std::string_view key,
                              std::initializer_list<std::string_view> words) const {
  asked_.emplace_back(key);
  const Value* value = map_.find(key);
  return value == nullptr ? std::string(*words.begin()) : value->word_of(words);
}

void ModuleEntry::finish() const {
  std::vector<std::string_view> all(std::begin(common_keys), std::end(common_keys));
  all.insert(all.end(), asked_.begin(), asked_.end());
  map_.allow(all);
}

ModuleKinds::ModuleKinds() {
  const std::pair<const char*, ReadModule (*)(const Map&)> own[] = {
      {"torque_arm", torque_arm_of},
      {"multiplex", multiplex_of},
      {"spaceball", spaceball_of},
      {"relief", relief_of},
      {"kbb2", kbb2_of},
      {"guide", guide_of},
      {"obstacle", obstacle_of},
      {"puma_kin", plain_of<network::PumaKin>},
      {"arm_obstacle", arm_obstacle_of},
      {"limits", limits_of},
      {"posture", posture_of},
      {"force_sensor", force_sensor_of},
      {"visual", plain_of<network::Visual>},
      {"puma_joints", joints_of},
      {"ground", ground_of},
      {"line", line_of},
      {"six_axes", six_axes_of},
      {"junction", junction_of},
      {"spring", read_element<Element::Kind::spring>},
      {"damper", read_element<Element::Kind::damper>},
      {"mass", read_element<Element::Kind::mass>}};
  for (const auto& [word, read] : own) {
    insert(word, [read = read](const ModuleEntry& entry) { return read(entry.map()); });
  }
}

void ModuleKinds::insert(const std::string& word, Read read) {
  if (!kinds_.emplace(word, std::move(read)).second) {
    throw SetupError("there is a module '" + word + "' already; allowed: another word");
  }
  words_.push_back(word);
}

}  // namespace repel::scene
