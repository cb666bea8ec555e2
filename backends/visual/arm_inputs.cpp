// SPDX-License-Identifier: BSD-3-Clause
#include "arm_inputs.hpp"

#include <string>

#include <repel/network/elements/changing_scale.hpp>

namespace repel::visual {
namespace {

using Json = nlohmann::json;
using network::FixtureKind;
using network::FixtureOptions;
using network::Relief;

/// The word of a scene for its shape.
const char* shape_of(const FixtureOptions& fixture) {
  switch (fixture.kind) {
    case FixtureKind::point:
      return "point";
    case FixtureKind::plane:
      return "plane";
    case FixtureKind::cone:
      return "cone";
    case FixtureKind::path:
      return fixture.radius > 0.0 ? "tube" : "path";
    case FixtureKind::line:
      break;
  }
  if (fixture.radius > 0.0) return "tube";
  return fixture.alignment == network::Alignment::axis ? "axis" : "line";
}

/// [m] Points of the path, in its order: those between which it is nearly straight.
Json course_of(const FixtureOptions& fixture) {
  const network::FixturePath path(fixture.points, {}, fixture.course);
  const int steps = fixture.course == network::Course::spline ? 10 : 1;
  Json course = Json::array();
  const auto add = [&](std::size_t piece, double along) {
    const Vec3 p = path.at({piece, along}).p_W;
    course.push_back({rounded(p.x()), rounded(p.y()), rounded(p.z())});
  };
  for (std::size_t i = 0; i < path.pieces(); ++i) {
    for (int k = 0; k < steps; ++k) add(i, path.length(i) * k / steps);
  }
  add(path.pieces() - 1, path.length(path.pieces() - 1));
  return course;
}

Json to_json(const FixtureOptions& fixture) {
  Json json{{"name", fixture.name},
            {"shape", shape_of(fixture)},
            {"radius_m", fixture.radius},
            {"range_m", fixture.range}};
  if (fixture.kind == FixtureKind::path) {
    json["course"] = course_of(fixture);
  } else {
    json["pose"] = visual::to_json(fixture.X_WF);
  }
  if (fixture.kind == FixtureKind::cone) json["half_angle_rad"] = fixture.half_angle;
  return json;
}

bool is_on(const ArmInfo& arm, const network::HandInput& hand, std::size_t fixture) {
  if (hand.guides < 0) return arm.fixtures[fixture].is_on;
  return (hand.guides >> static_cast<int>(fixture) & 1) != 0;
}

void write_compliant(const network::ReliefOptions& relief, std::int32_t compliant, JsonText& out) {
  const bool as_set_up = compliant < 0;
  out.name("compliant").open('[');
  for (std::size_t i = 0; i < Relief::directions.size(); ++i) {
    const bool gives =
        as_set_up ? relief.compliant[i] : (compliant >> static_cast<int>(i) & 1) != 0;
    if (gives) out.json(Json(Relief::directions[i]).dump());
  }
  const bool is_world = as_set_up ? relief.frame == network::ReliefFrame::world
                                  : (compliant & Relief::world_bit) != 0;
  out.close(']').name("compliant_frame").json(is_world ? "\"world\"" : "\"tool\"");
}

void write_grip(const char* force, const char* torque, const Wrench& grip, JsonText& out) {
  out.name(force).vector(grip.force).name(torque).vector(grip.torque);
}

}  // namespace

Json to_json(const Pose& X) {
  const Vec3 p = X.translation();
  const Eigen::Quaterniond q(X.linear());
  return {rounded(p.x()), rounded(p.y()), rounded(p.z()), rounded(q.x()),
          rounded(q.y()), rounded(q.z()), rounded(q.w())};
}

void add_inputs(const ArmInfo& arm, Json& json) {
  for (const FixtureOptions& fixture : arm.fixtures) {
    json["fixtures"].push_back(to_json(fixture));
  }
  for (std::size_t i = 0; arm.relief && i < Relief::directions.size(); ++i) {
    if (Relief::may_give(*arm.relief, i)) json["compliant"].push_back(Relief::directions[i]);
  }
  if (arm.has_scale) {
    json["scale"] = {network::ChangingScale::least, network::ChangingScale::most};
  }
  if (arm.has_second_handle) json["hands"] = 2;
}

void write_inputs(const ArmInfo& arm, const TickRecord& k, JsonText& out) {
  const network::HandInput& hand = k.command.hand;
  if (!arm.fixtures.empty()) {
    out.name("guides").open('[');
    for (std::size_t i = 0; i < arm.fixtures.size(); ++i) {
      if (!is_on(arm, hand, i)) continue;
      out.json(Json(arm.fixtures[i].name).dump(-1, ' ', false, Json::error_handler_t::replace));
    }
    out.close(']').name("guide_strength").number(hand.guide_strength);
  }
  if (arm.relief) write_compliant(*arm.relief, hand.compliant, out);
  if (arm.has_scale) out.name("scale").number(hand.scale);
  if (arm.has_handle) write_grip("grip_n", "grip_nm", k.grip, out);
  if (arm.has_second_handle) write_grip("second_grip_n", "second_grip_nm", k.second_grip, out);
}

}  // namespace repel::visual
