// SPDX-License-Identifier: BSD-3-Clause
#include "grammar.hpp"

#include <algorithm>
#include <array>
#include <initializer_list>
#include <string>

#include <repel/base/capacities.hpp>
#include <repel/distance/query.hpp>
#include <repel/network/elements/changing_scale.hpp>
#include <repel/network/elements/fixture.hpp>
#include <repel/scene/camera.hpp>
#include <repel/schedule/coprocessor_options.hpp>
#include <repel/simulated/changed_arm.hpp>

#include "pose_reader.hpp"

namespace repel::scene::grammar {
namespace {

using namespace key;
using Words = std::vector<std::string_view>;

/// Lists that follow each other.
Keys joined(std::initializer_list<Keys> lists) {
  Keys all;
  for (const Keys& list : lists) all.insert(all.end(), list.begin(), list.end());
  return all;
}

const Keys& pose() {
  static const Keys keys{vector("position", detail::position), vector("rpy", detail::angles)};
  return keys;
}

const Keys& sizes() {
  static const Rule extent{unit::length, 0.0, Shape::largest};
  static const Keys keys{vector("size", extent),
                         number("radius", unit::length, 0.0, Shape::largest),
                         number("length", unit::length, 0.0, Shape::largest),
                         any("points"),
                         text("file"),
                         text("parts")};
  return keys;
}

const Keys& paint() {
  static const Keys keys{color("color"), number("opacity", unit::share, 0.01, 1.0)};
  return keys;
}

/// Of a part with these shapes, before `own` keys.
Keys part(const Words& shapes, const Keys& own) {
  return joined(
      {{text("name").required(), word("shape", shapes).required()}, pose(), own, sizes()});
}

const Words tool_shapes{"box",  "sphere",    "capsule", "cylinder",
                        "cone", "ellipsoid", "hull",    "mesh"};

Keys station() {
  return {map("robot", robot()).required(), maps("tool", tool_part()).required(),
          maps("network", any_module()), maps("script", phase())};
}

Keys camera_keys() {
  return {number("nearest", unit::length, 1e-3, 100.0),
          number("farthest", unit::length, 1e-3, 1000.0),
          number("latency", unit::time, 0.0, 10.0),
          word("unseen", {"free", "solid"}),
          number("margin", unit::length, 0.0, 1.0),
          integer("parts", 80, 2000),
          number("silent_after", unit::time, 1e-3, 1e3),
          text("law"),
          map("map", camera_map()),
          text("recording"),
          flag("repeat"),
          vector("position", detail::position),
          vector("look_at", detail::position),
          any("orientation"),
          integer("width", 16, 1920),
          integer("height", 16, 1080),
          number("view", unit::angle, 0.1, 2.6),
          number("rate", unit::frequency, 0.1, most_camera_rate_hz),
          number("noise", unit::length, 0.0, 0.1),
          number("lost", unit::none, 0.0, 1.0),
          integer("seed", 0, most_seed)};
}

}  // namespace

const Keys& frame() {
  return pose();
}

const Keys& payload() {
  static const Keys keys{number("mass", unit::mass, 0.0, Payload::heaviest).required(),
                         vector("position", {unit::length, -Payload::furthest, Payload::furthest}),
                         flag("known")};
  return keys;
}

const Keys& admittance() {
  static const Keys keys{number("response", unit::time, 0.01, 1.0),
                         number("scale", unit::share, 1e-3, 1e3),
                         number("rest_time", unit::time, 1e-3, 1e3)};
  return keys;
}

const Keys& sensor_errors() {
  static const Keys keys{
      number("force_noise", unit::force, 0.0, 1e6), number("torque_noise", unit::torque, 0.0, 1e6),
      vector("force_bias", {unit::force, -1e6, 1e6}),
      vector("torque_bias", {unit::torque, -1e6, 1e6}), integer("seed", 0, most_seed)};
  return keys;
}

const Keys& robot() {
  static const Keys keys{text("urdf"),
                         text("mjcf"),
                         text("tip_link"),
                         any("start").required(),
                         map("base", frame()),
                         map("tool_frame", frame()),
                         texts("links"),
                         text("self_law"),
                         text("srdf"),
                         map("payload", payload()),
                         any("hold"),
                         texts("packages"),
                         integer("drive_delay", 0, 100),
                         flag("covers"),
                         map("admittance", admittance()),
                         map("sensor_errors", sensor_errors())};
  return keys;
}

const Keys& tool_part() {
  static const Keys keys = part(tool_shapes, paint());
  return keys;
}

const Keys& law() {
  static const Keys keys{
      number("range", unit::length, 1e-6, 1e3),
      number("surface_force", unit::force, 0.0, 1e6),
      {"damping", Key::Kind::number, {.units = unit::damping, .high = 1e6, .may_be_auto = true}},
      number("ceiling", unit::force, 0.0, 1e6),
      word("given_at", {"part", "tool"}),
      number("tilt", unit::angle, 0.0, ForceLaw::most_tilt),
      word("hold", {"soft", "hard"}),
      flag("passable"),
      number("depth", unit::length, 0.0, 1e6),
      number("plateau", unit::none, 0.0, 1.0)};
  return keys;
}

const Keys& motion() {
  static const Keys keys{vector("along", detail::position).required(),
                         number("duration", unit::time, 1e-3, 86400.0).required()};
  return keys;
}

const Keys& obstacle() {
  static const Keys keys = [] {
    Words shapes = tool_shapes;
    shapes.insert(shapes.end(), {"urdf", "sdf", "mjcf"});
    return joined({part(shapes, {text("law"), map("motion", motion())}),
                   {texts("packages"), flag("covers")},
                   paint()});
  }();
  return keys;
}

const Keys& loose() {
  static const Keys keys = joined(
      {part(tool_shapes, {text("law"), flag("at_start"),
                          number("mass", unit::mass, 0.0, Payload::heaviest), flag("known")}),
       paint()});
  return keys;
}

const Keys& spare() {
  static const Keys keys{integer("count", 0, 50).required(),
                         number("room", unit::length, 1e-3, 100.0), text("law")};
  return keys;
}

const Keys& hidden() {
  static const Keys keys = part(tool_shapes, {map("motion", motion())});
  return keys;
}

const Keys& camera_map() {
  static const Keys keys{number("cube", unit::length, 0.005, 1.0),
                         number("keeps", unit::time, 0.0, 1e6)};
  return keys;
}

const Keys& camera() {
  static const Keys keys = camera_keys();
  return keys;
}

const Keys& named_camera() {
  static const Keys keys = joined({camera_keys(), {text("name").required()}});
  return keys;
}

const Keys& budget() {
  static const Keys keys{number("wall", unit::time, 0.0, 1.0), integer("work", 0, 1e9),
                         integer("threads", 0, Capacities{}.threads), integer("max_age", 1, 1e9)};
  return keys;
}

const Keys& second_hand() {
  static const Keys keys{vector("linear", {unit::speed, -10.0, 10.0, true}),
                         vector("angular", {unit::angular_speed, -100.0, 100.0, true}),
                         vector("direction", {unit::none, -1e3, 1e3}),
                         {"lever", Key::Kind::number, {unit::angular_speed, -100.0, 100.0, true}}};
  return keys;
}

const Keys& phase() {
  static const Keys keys = joined(
      {{text("name").required(), word("device", {"spaceball", "torque_arm", "six_axes"}).required(),
        word("frame", {"world", "tool"}), number("duration", unit::time, 1e-3, 86400.0).required(),
        flag("silent"), number("over", unit::time, 0.0, 60.0), texts("blind"),
        number("scale", unit::share, network::ChangingScale::least, network::ChangingScale::most),
        map("second", second_hand()), texts("spawn"), texts("grip"), texts("release"),
        texts("remove"), texts("guides"), number("guide_strength", unit::share, 0.0, 1.0),
        texts("compliant"), word("compliant_frame", {"tool", "world"})},
       second_hand(),
       {number("pitch", unit::length_per_angle, -10.0, 10.0),
        vector("axis", {unit::length, -10.0, 10.0})}});
  return keys;
}

const Keys& fixture() {
  static const Keys keys = joined(
      {{text("name").required(),
        word("shape", {"point", "line", "axis", "plane", "path", "tube", "cone"}).required()},
       fields<network::FixtureOptions>(),
       {flag("on")},
       pose(),
       {number("radius", unit::length, 0.0, 1e3), number("half_angle", unit::angle, 0.01, 1.56),
        any("points"), any("frames"), word("course", {"straight", "spline"})}});
  return keys;
}

const Keys& any_module() {
  static const Keys keys{text("module").required(), text("name"), texts("to")};
  return keys;
}

const Keys& partner() {
  static const Keys keys = joined({{text("name").required(), text("law")}, station()});
  return keys;
}

const Keys& scene() {
  static const Keys keys = [] {
    static std::array<std::string, all_measures.size()> names;
    std::transform(all_measures.begin(), all_measures.end(), names.begin(),
                   [](Measure each) { return to_text(each); });
    const Words measures(names.begin(), names.end());
    const Words modes(coprocessor_mode_names.begin(), coprocessor_mode_names.end());
    return joined({{text("name"), number("rate", unit::frequency, 1.0, 1e5)},
                   station(),
                   {Key{"laws", Key::Kind::named, {}, {}, &law()},
                    maps("obstacles", obstacle()).required(), maps("loose", loose()),
                    map("spare", spare()), map("camera", camera()), maps("cameras", named_camera()),
                    maps("hidden", hidden()), maps("partners", partner()), map("budget", budget()),
                    word("coprocessor", modes), word("start_inside", {"refuse", "push_out"}),
                    number("tool_speed", unit::speed, 1e-3, 10.0), word("measure", measures),
                    integer("levels", 1, ReductionOptions::most_levels), flag("apart")}});
  }();
  return keys;
}

}  // namespace repel::scene::grammar
