// SPDX-License-Identifier: BSD-3-Clause
#include "guide_reader.hpp"

#include <set>
#include <string>
#include <vector>

#include <repel/network/modules/relief.hpp>

#include "grammar.hpp"
#include "pose_reader.hpp"

namespace repel::scene {
namespace {

using network::Alignment;
using network::FixtureKind;
using network::FixtureOptions;

void read_path(const Map& map, FixtureOptions& fixture) {
  fixture.kind = FixtureKind::path;
  map.refuse({"position", "rpy", "half_angle"});
  for (const Value& point : map.at("points").list(network::FixturePath::most_points)) {
    fixture.points.push_back(point.vector(detail::position));
  }
  if (const Value* frames = map.find("frames")) {
    for (const Value& rpy : frames->list(network::FixturePath::most_points)) {
      fixture.frames.push_back(detail::rotation_of(rpy.vector(detail::angles)));
    }
    fixture.alignment = Alignment::all;
  }
  map.read("course", fixture.course);
}

void read_shape(const Map& map, FixtureOptions& fixture) {
  const std::string_view shape = map.word("shape");
  if (shape == "path" || (shape == "tube" && map.find("points") != nullptr)) {
    read_path(map, fixture);
  } else if (shape == "cone") {
    fixture.kind = FixtureKind::cone;
    map.refuse({"radius", "points", "frames", "course"});
    fixture.half_angle = map.number("half_angle");
  } else {
    map.refuse({"half_angle", "points", "frames", "course"});
    fixture.kind = shape == "point"   ? FixtureKind::point
                   : shape == "plane" ? FixtureKind::plane
                                      : FixtureKind::line;
    if (shape == "axis") fixture.alignment = Alignment::axis;
  }
  if (fixture.kind != FixtureKind::path) fixture.X_WF = detail::pose_of(map);
  if (shape == "tube") (void)map.at("radius");
  map.read("radius", fixture.radius);
}

FixtureOptions fixture_of(const Value& value) {
  const Map map(value, grammar::fixture());
  FixtureOptions fixture;
  fixture.name = map.at("name").text();
  read_shape(map, fixture);
  map.read_fields(fixture);
  map.read("on", fixture.is_on);
  (void)value.located([&] { return network::checked_fixture(fixture); });
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
  map.read_fields(options);
  return options;
}

std::array<bool, 6> detail::directions_of(const Value& list) {
  std::array<bool, 6> directions{};
  for (const Value& entry : list.list()) {
    directions[entry.index_in(network::Relief::directions)] = true;
  }
  return directions;
}

}  // namespace repel::scene
