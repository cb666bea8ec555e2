// SPDX-License-Identifier: BSD-3-Clause
#include "page_input.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include <nlohmann/json.hpp>

#include <repel/common/json_fields.hpp>
#include <repel/network/elements/changing_scale.hpp>
#include <repel/visual/page_command.hpp>

namespace repel::visual {
namespace {

using Json = nlohmann::json;
using network::Relief;

/// Limits the length: no page can command more than the master of the scene can.
Vec3 within(const Vec3& v, double most) {
  const double length = v.norm();
  return length > most ? Vec3(v * (most / length)) : v;
}

/// The hand of that message; none: neither of the two.
std::optional<network::Hand> hand_of(const Json& message) {
  if (!message.contains("hand")) return network::Hand::first;
  const std::string word = fields::text(message, "hand");
  if (word == "first") return network::Hand::first;
  if (word == "second") return network::Hand::second;
  return std::nullopt;
}

/// The texts of the list of that name; none: it is no list of texts.
std::optional<std::vector<std::string>> texts(const Json& message, const char* name) {
  const Json& entries = fields::member(message, name);
  if (!entries.is_array()) return std::nullopt;
  std::vector<std::string> list;
  for (const Json& entry : entries) {
    if (!entry.is_string()) return std::nullopt;
    list.push_back(entry.get<std::string>());
  }
  return list;
}

std::string listed(const std::vector<network::FixtureOptions>& fixtures) {
  std::string names;
  for (const network::FixtureOptions& each : fixtures) {
    if (!names.empty()) names += ", ";
    names += each.name;
  }
  return names;
}

constexpr const char* no_hand = "a hand is first or second";

}  // namespace

bool PageInput::knows(const std::string& type) {
  return type == "servo_cv" || type == "servo_lever" || type == "scale" || type == "guides" ||
         type == "compliant";
}

std::string PageInput::take(const std::string& type, const Json& message, Time now) {
  if (type == "servo_cv") return move(message, now);
  if (type == "servo_lever") return lead_lever(message, now);
  if (type == "scale") return set_scale(message);
  if (type == "guides") return set_guides(message);
  return set_compliant(message);
}

void PageInput::rest(Driver driver) {
  input_.driver = driver;
  input_.rates = input_.second = {};
  input_.in_tool = input_.second_in_tool = false;
  input_.lever_rate = 0.0;
  input_.direction_W = DriverInput{}.direction_W;
}

void PageInput::forget() {
  const Driver driver = input_.driver;
  input_ = {};
  input_.driver = driver;
}

DriverInput PageInput::of(Time now) const {
  const auto is_old = [&](Time said) {
    return std::chrono::duration<double>(now - said).count() > PageCommand::rest_after;
  };
  DriverInput input = input_;
  if (is_old(first_said_)) {
    input.rates = {};
    input.lever_rate = 0.0;
  }
  if (is_old(second_said_)) input.second = {};
  return input;
}

std::string PageInput::move(const Json& message, Time now) {
  const auto linear = fields::vector(message, "linear", 10.0);
  const auto angular = fields::vector(message, "angular", 100.0);
  const std::string frame = fields::text(message, "frame");
  if (!linear || !angular || (frame != "world" && frame != "tool")) return out_of_range;
  const auto hand = hand_of(message);
  if (!hand) return no_hand;
  if (*hand == network::Hand::second && !arm_.has_second_handle)
    return "the network has no master in a second hand";
  const bool held = fields::value_of<bool>(fields::member(message, "clutch")).value_or(false);
  Twist rates;
  if (held) rates = {within(*linear, arm_.max_speed), within(*angular, arm_.max_turn)};
  if (*hand == network::Hand::second) {
    input_.second = rates;
    input_.second_in_tool = frame == "tool";
    second_said_ = now;
    return {};
  }
  input_.rates = rates;
  input_.in_tool = frame == "tool";
  input_.lever_rate = 0.0;
  input_.direction_W = DriverInput{}.direction_W;
  first_said_ = now;
  return {};
}

std::string PageInput::lead_lever(const Json& message, Time now) {
  const auto direction = fields::vector(message, "direction", 1e3);
  const auto rate = fields::number(message, "rate", 100.0);
  if (!direction || !rate || direction->norm() < 1e-6) return out_of_range;
  const auto hand = hand_of(message);
  if (!hand) return no_hand;
  if (*hand == network::Hand::second) return "a page leads the lever of the first hand only";
  input_.rates = {};
  input_.in_tool = false;
  input_.direction_W = direction->normalized();
  input_.lever_rate = std::clamp(*rate, -arm_.max_lever_rate, arm_.max_lever_rate);
  first_said_ = now;
  return {};
}

std::string PageInput::set_scale(const Json& message) {
  if (!arm_.has_scale) return "the network has no scale: it has no force-reflecting master";
  const auto factor = fields::number(message, "factor", network::ChangingScale::most);
  if (!factor || *factor < network::ChangingScale::least) return out_of_range;
  input_.scale = *factor;
  return {};
}

std::string PageInput::set_guides(const Json& message) {
  if (arm_.fixtures.empty()) return "the network has no fixtures";
  const auto names = texts(message, "on");
  if (!names) return "'on' is no list of names";
  std::int32_t bits = 0;
  for (const std::string& name : *names) {
    const auto found = std::find_if(arm_.fixtures.begin(), arm_.fixtures.end(),
                                    [&](const auto& each) { return each.name == name; });
    if (found == arm_.fixtures.end())
      return "there is no such fixture; there are: " + listed(arm_.fixtures);
    bits |= 1 << (found - arm_.fixtures.begin());
  }
  if (message.contains("strength")) {
    const auto strength = fields::number(message, "strength", 1.0);
    if (!strength || *strength < 0.0) return out_of_range;
    input_.guide_strength = *strength;
  }
  input_.guides = bits;
  return {};
}

std::string PageInput::set_compliant(const Json& message) {
  if (!arm_.relief) return "the network has no module relief";
  const auto words = texts(message, "directions");
  if (!words) return "'directions' is no list of them";
  std::int32_t bits = 0;
  for (const std::string& word : *words) {
    const auto found = std::find(Relief::directions.begin(), Relief::directions.end(), word);
    if (found == Relief::directions.end()) return "a direction is x, y, z, rx, ry or rz";
    const auto i = static_cast<std::size_t>(found - Relief::directions.begin());
    if (!Relief::may_give(*arm_.relief, i))
      return "this direction has neither stiffness nor damping";
    bits |= 1 << i;
  }
  bool is_world = arm_.relief->frame == network::ReliefFrame::world;
  if (message.contains("frame")) {
    const std::string frame = fields::text(message, "frame");
    if (frame != "world" && frame != "tool") return "a frame is world or tool";
    is_world = frame == "world";
  }
  if (is_world) bits |= Relief::world_bit;
  input_.compliant = bits;
  return {};
}

}  // namespace repel::visual
