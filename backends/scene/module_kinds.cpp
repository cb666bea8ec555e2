// SPDX-License-Identifier: BSD-3-Clause
#include <repel/scene/module_kinds.hpp>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include <repel/base/setup_error.hpp>
#include <repel/network/modules.hpp>

#include "grammar.hpp"
#include "guide_reader.hpp"
#include "yaml.hpp"

namespace repel::scene {
namespace {

using grammar::ModuleKind;

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

/// A module of which only the fields of its options are read.
/// @param more keys read elsewhere
template <class M, class Options>
ModuleKind kind_of_fields(std::string_view word, const Keys& more = {}) {
  const auto read = [](const Map& map) {
    Options options;
    map.read_fields(options);
    return made_of(options, make<M, Options>, M::traits.walls);
  };
  return {word, key::fields<Options>(more), read};
}

ReadModule multiplex_of(const Map& map) {
  network::MultiplexOptions options;
  map.read_fields(options);
  // Lossless unless the file says otherwise.
  if (map.find("force_scale") == nullptr) options.force_scale = options.velocity_scale;
  return made_of(options, make<network::Multiplex>);
}

ReadModule relief_of(const Map& map) {
  network::ReliefOptions options;
  if (const Value* list = map.find("compliant")) {
    options.compliant = detail::directions_of(*list);
  }
  map.read_fields(options);
  return made_of(options, make<network::Relief>);
}

ReadModule guide_of(const Map& map) {
  return made_of(detail::guide_of(map), make<network::Guide>);
}

ReadModule force_sensor_of(const Map& map) {
  network::ForceSensorOptions options;
  map.read_fields(options);
  map.read("position", options.p_TC);
  return {options, [options](const ArmModel& arm) {
            network::ForceSensorOptions own = options;
            own.gravity_W = arm.gravity_W;
            return network::ForceSensor(own);
          }};
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
  network::JointLimits law;
  const LimitZones zones(map);
  map.read_fields(law);
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
  network::PostureOptions options;
  map.read_fields(options);
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

ReadModule line_module_of(const Map& map) {
  network::LineOptions options;
  map.read_fields(options);
  map.read("buffer", options.buffer);
  map.read("seed", options.channel.seed);
  return made_of(options, make<network::Line>);
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

/// A spring, damper or mass, by the names of its two numbers.
ModuleKind element(std::string_view word, Element::Kind kind, std::string_view linear,
                   Units linear_units, std::string_view angular, Units angular_units) {
  const auto read = [=](const Map& map) {
    Element element{.kind = kind};
    if (map.find("space") != nullptr && map.word("space") == "lever") {
      element.space = network::Space::lever;
      map.refuse({linear});
    } else {
      element.linear = map.number(linear);
    }
    element.angular = map.number(angular);
    return made_of(element, element_from);
  };
  return {word,
          {key::word("space", {"tool", "lever"}), key::number(linear, linear_units, 1e-9, 1e7),
           key::number(angular, angular_units, 1e-9, 1e7).required()},
          read};
}

ReadModule junction_of(const Map& map) {
  network::Common common = network::Common::flow;
  map.read("common", common);
  return made_of(common, make<network::Junction>);
}

/// A module without options.
template <class M>
ReadModule plain_of(const Map& /*map*/) {
  return {{}, [](const ArmModel& /*arm*/) { return M(); }};
}

ReadModule joints_of(const Map& /*map*/) {
  return {{}, [](const ArmModel& arm) {
            return network::PumaJoints(static_cast<int>(arm.links.size()));
          }};
}

std::vector<ModuleKind> kinds_of_library() {
  using namespace key;
  using namespace network;
  std::vector<ModuleKind> all{
      kind_of_fields<TorqueArm, TorqueArmOptions>("torque_arm"),
      {"multiplex", fields<MultiplexOptions>(), multiplex_of},
      kind_of_fields<Spaceball, SpaceballOptions>("spaceball"),
      {"relief", fields<ReliefOptions>({texts("compliant")}), relief_of},
      kind_of_fields<Kbb2, Kbb2Options>("kbb2"),
      {"guide", fields<GuideOptions>({maps("fixtures", grammar::fixture()).required()}), guide_of},
      kind_of_fields<network::Obstacle, ObstacleOptions>(
          "obstacle", {word("gain_check", {"error", "warning"})}),
      {"puma_kin", {}, plain_of<PumaKin>},
      kind_of_fields<ArmObstacle, ArmObstacleOptions>("arm_obstacle"),
      {"limits", fields<JointLimits>({any("range")}), limits_of},
      {"posture", fields<PostureOptions>({}, {any("joints")}), posture_of},
      {"force_sensor",
       fields<ForceSensorOptions>({}, {vector("position", {unit::length, -5.0, 5.0})}),
       force_sensor_of},
      {"visual", {}, plain_of<Visual>},
      {"puma_joints", {}, joints_of},
      {"ground", {}, plain_of<Ground>},
      {"line",
       fields<LineOptions>(
           {}, {number("buffer", unit::time, 0.0, 10.0), integer("seed", 0, most_seed)}),
       line_module_of},
      kind_of_fields<SixAxes, SixAxesOptions>("six_axes"),
      {"junction", {word("common", {"flow", "effort"})}, junction_of},
      element("spring", Element::Kind::spring, "stiffness", unit::stiffness, "angular_stiffness",
              unit::angular_stiffness),
      element("damper", Element::Kind::damper, "damping", unit::damping, "angular_damping",
              unit::angular_damping),
      element("mass", Element::Kind::mass, "mass", unit::mass, "inertia", unit::inertia)};
  const Keys& first = grammar::any_module();
  for (ModuleKind& each : all) each.keys.insert(each.keys.begin(), first.begin(), first.end());
  return all;
}

}  // namespace

const std::vector<ModuleKind>& grammar::module_kinds() {
  static const std::vector<ModuleKind> all = kinds_of_library();
  return all;
}

double ModuleEntry::number(std::string_view key, std::string_view unit, double low, double high,
                           double otherwise) const {
  asked_.emplace_back(key);
  const Units units = unit::of_dimension(unit);
  const Value* const value = map_.find(key);
  return value == nullptr ? otherwise : value->number({units, low, high});
}

std::string ModuleEntry::word(std::string_view key,
                              std::initializer_list<std::string_view> words) const {
  asked_.emplace_back(key);
  const Value* value = map_.find(key);
  return value == nullptr ? std::string(*words.begin()) : value->word_of(words);
}

void ModuleEntry::finish() const {
  std::vector<std::string_view> all;
  for (const Key& key : grammar::any_module()) all.push_back(key.name);
  all.insert(all.end(), asked_.begin(), asked_.end());
  map_.allow(all);
}

ModuleKinds::ModuleKinds() {
  for (const grammar::ModuleKind& kind : grammar::module_kinds()) {
    insert(std::string(kind.word),
           [&kind](const ModuleEntry& entry) { return kind.read(entry.map().with(kind.keys)); });
  }
}

void ModuleKinds::insert(const std::string& word, Read read) {
  if (!kinds_.emplace(word, std::move(read)).second) {
    throw SetupError("there is a module '" + word + "' already; allowed: another word");
  }
  words_.push_back(word);
}

}  // namespace repel::scene
