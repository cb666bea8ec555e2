// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The fields of a message from a page.
#pragma once

#include <cmath>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include <repel/base/types.hpp>

namespace repel::visual::fields {

inline constexpr const char* out_of_range = "a number is missing or out of range";

/// The number of that name, if within +-`most`.
inline std::optional<double> number(const nlohmann::json& message, const char* name, double most) {
  const auto found = message.find(name);
  if (found == message.end() || !found->is_number()) return std::nullopt;
  const double value = found->get<double>();
  if (!(std::abs(value) <= most)) return std::nullopt;
  return value;
}

/// The vector of that name, if its length is at most `most`.
inline std::optional<Vec3> vector(const nlohmann::json& message, const char* name, double most) {
  const auto found = message.find(name);
  if (found == message.end() || !found->is_array() || found->size() != 3) return std::nullopt;
  Vec3 v;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const nlohmann::json& entry = (*found)[axis];
    if (!entry.is_number()) return std::nullopt;
    v[static_cast<Eigen::Index>(axis)] = entry.get<double>();
  }
  if (!(v.norm() <= most)) return std::nullopt;
  return v;
}

/// The text of that name; empty if there is none.
inline std::string text(const nlohmann::json& message, const char* name) {
  const auto found = message.find(name);
  return found != message.end() && found->is_string() ? found->get<std::string>() : std::string();
}

}  // namespace repel::visual::fields
