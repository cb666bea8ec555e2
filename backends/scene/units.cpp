// SPDX-License-Identifier: BSD-3-Clause
#include "units.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include <repel/base/setup_error.hpp>

namespace repel::scene {
namespace {

constexpr std::string_view blanks = " \t\r\n";

/// Removes and returns the first word of `text`; empty at its end.
std::string_view next_word(std::string_view& text) {
  text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
  const std::string_view word = text.substr(0, text.find_first_of(blanks));
  text.remove_prefix(word.size());
  return word;
}

std::optional<double> number(std::string_view word) {
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc{} || end != word.data() + word.size()) return std::nullopt;
  return value;
}

}  // namespace

Units unit::of_dimension(std::string_view name) {
  for (const Units units :
       {Units(none), Units(length), Units(angle), Units(time), Units(frequency), Units(speed),
        Units(angular_speed), Units(force), Units(torque), Units(stiffness), Units(damping),
        Units(angular_stiffness), Units(angular_damping), Units(mass), Units(inertia),
        Units(energy), Units(share), Units(length_per_angle)}) {
    for (const Unit& each : units) {
      if (each.name == name) return units;
    }
  }
  throw SetupError("no unit is called '" + std::string(name) + "'");
}

std::optional<std::vector<double>> quantity(std::string_view text, Units units) {
  std::vector<double> values;
  std::string_view word = next_word(text);
  for (; !word.empty(); word = next_word(text)) {
    const auto value = number(word);
    if (!value) break;
    values.push_back(*value);
  }
  std::string name;  // the words of the unit, separated by single blanks
  for (; !word.empty(); word = next_word(text)) {
    if (!name.empty()) name += ' ';
    name += word;
  }
  for (const Unit& unit : units) {
    if (unit.name != name) continue;
    for (double& value : values) value = value * unit.times / unit.over;
    return values;
  }
  return std::nullopt;
}

bool obeys(double value, const Rule& rule) {
  if (std::isnan(value)) return rule.may_be_nan;
  return value >= rule.low && value <= rule.high;
}

std::string range_text(const Rule& rule) {
  std::string text = to_text(rule.low) + " to " + to_text(rule.high);
  const std::string_view si = rule.units.front().name;
  if (!si.empty()) text.append(" ").append(si);
  return rule.may_be_auto ? text + ", or auto" : text;
}

std::string units_text(Units units) {
  std::string text(units.front().name);
  for (std::size_t i = 1; i < units.size(); ++i) {
    text += i + 1 == units.size() ? " or " : ", ";
    text += units[i].name;
  }
  return text;
}

}  // namespace repel::scene
