// SPDX-License-Identifier: BSD-3-Clause
#include "guide_reader.hpp"

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "pose_reader.hpp"

namespace repel::scene {
namespace {

using network::Alignment;
using network::FixtureKind;
using network::FixtureOptions;

constexpr std::string_view fixture_keys[] = {
    "name",        "shape",         "stiffness", "damping",           "most_force",
    "range",       "most_energy",   "alignment", "angular_stiffness", "angular_damping",
    "most_torque", "angular_range", "on"};

/// With the keys of its shape.
void allow_fixture(const Map& map, std::initializer_list<std::string_view> own) {
  std::vector<std::string_view> keys(std::begin(fixture_keys), std::end(fixture_keys));
  keys.insert(keys.end(), own.begin(), own.end());
  map.allow(keys);
}

Rule gain(Units units, double high) {
  return {.units = units, .low = 0.0, .high = high, .may_be_auto = true};
}

void read_path(const Map& map, FixtureOptions& fixture) {
  fixture.kind = FixtureKind::path;
  allow_fixture(map, {"points", "frames", "course", "radius"});
  for (const Value& point : map.at("points").list(network::FixturePath::most_points)) {
    fixture.points.push_back(point.vector(detail::position));
  }
  if (const Value* frames = map.find("frames")) {
    for (const Value& rpy : frames->list(network::FixturePath::most_points)) {
      fixture.frames.push_back(detail::rotation_of(rpy.vector(detail::angles)));
    }
    fixture.alignment = Alignment::all;
  }
  if (const Value* course = map.find("course")) {
    const bool is_spline = course->word_of({"spline", "straight"}) == "spline";
    fixture.course = is_spline ? network::Course::spline : network::Course::straight;
  }
}

void read_shape(const Map& map, FixtureOptions& fixture) {
  const std::string shape =
      map.at("shape").word_of({"point", "line", "axis", "plane", "path", "tube", "cone"});
  if (shape == "path" || (shape == "tube" && map.find("points") != nullptr)) {
    read_path(map, fixture);
  } else if (shape == "cone") {
    fixture.kind = FixtureKind::cone;
    allow_fixture(map, {"position", "rpy", "half_angle"});
    fixture.half_angle = map.at("half_angle").number({unit::angle, 0.01, 1.56});
  } else {
    allow_fixture(map, {"position", "rpy", "radius"});
    fixture.kind = shape == "point"   ? FixtureKind::point
                   : shape == "plane" ? FixtureKind::plane
                                      : FixtureKind::line;
    if (shape == "axis") fixture.alignment = Alignment::axis;
  }
  if (fixture.kind != FixtureKind::path) fixture.X_WF = detail::pose_of(map);
  if (shape == "tube") (void)map.at("radius");
  map.read("radius", {unit::length, 0.0, 1e3}, fixture.radius);
}

FixtureOptions fixture_of(const Value& value) {
  const Map map(value);
  FixtureOptions fixture;
  fixture.name = map.at("name").text();
  read_shape(map, fixture);
  map.read("stiffness", gain(unit::stiffness, 1e7), fixture.stiffness);
  map.read("damping", gain(unit::damping, 1e6), fixture.damping);
  map.read("most_force", {unit::force, 1e-9, 1e6}, fixture.most_force);
  map.read("range", {unit::length, 1e-6, 1e3}, fixture.range);
  map.read("most_energy", {unit::energy, 1e-9, 1e6}, fixture.most_energy);
  if (const Value* alignment = map.find("alignment")) {
    const std::string word = alignment->word_of({"free", "axis", "all"});
    fixture.alignment = word == "free"   ? Alignment::free
                        : word == "axis" ? Alignment::axis
                                         : Alignment::all;
  }
  map.read("angular_stiffness", gain(unit::angular_stiffness, 1e6), fixture.angular_stiffness);
  map.read("angular_damping", gain(unit::angular_damping, 1e6), fixture.angular_damping);
  map.read("most_torque", {unit::torque, 1e-9, 1e6}, fixture.most_torque);
  map.read("angular_range", {unit::angle, 1e-6, 2.0}, fixture.angular_range);
  map.read("on", fixture.is_on);
  try {
    (void)network::checked_fixture(fixture);
  } catch (const SetupError& error) {
    value.fail(error.what());
  }
  return fixture;
}

}  // namespace

network::GuideOptions detail::guide_of(const Map& map) {
  network::GuideOptions options;
  std::set<std::string> names;
  for (const Value& entry : map.at("fixtures").list(network::Guide::most_fixtures)) {
    options.fixtures.push_back(fixture_of(entry));
    if (names.insert(options.fixtures.back().name).second) continue;
    Map(entry).at("name").fail_with_value("a name that no other fixture has");
  }
  map.read("ramp", {unit::time, 1e-3, 100.0}, options.ramp);
  map.read("entry_energy", {unit::energy, 1e-3, 1e3}, options.entry_energy);
  map.read("most_energy", {unit::energy, 0.0, 1e6}, options.passivity.most_energy);
  map.read("most_damping", {unit::damping, 0.0, 1e6}, options.passivity.most_damping);
  return options;
}

std::array<bool, 6> detail::directions_of(const Value& list) {
  constexpr std::array<std::string_view, 6> words{"x", "y", "z", "rx", "ry", "rz"};
  std::array<bool, 6> directions{};
  for (const Value& entry : list.list()) {
    const std::string word = entry.word_of(words);
    directions[static_cast<std::size_t>(std::find(words.begin(), words.end(), word) -
                                        words.begin())] = true;
  }
  return directions;
}

}  // namespace repel::scene
