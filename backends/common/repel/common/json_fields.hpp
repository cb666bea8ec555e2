// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Checked fields of untrusted JSON. For parts that link nlohmann-json.
#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <type_traits>

#include <nlohmann/json.hpp>

#include <repel/base/types.hpp>

namespace repel::fields {

using Json = nlohmann::json;  ///< untrusted

/// What stands under that name; discarded if `object` is no object, or has no such name.
inline const Json& member(const Json& object, const char* name) {
  static const Json none(Json::value_t::discarded);
  const auto found = object.find(name);
  return found == object.end() ? none : *found;
}

/// The value, if it is of that type: bool, a whole number, double or a text.
template <class T>
std::optional<T> value_of(const Json& json) {
  const bool is_one = std::is_same_v<T, bool>       ? json.is_boolean()
                      : std::is_integral_v<T>       ? json.is_number_integer()
                      : std::is_floating_point_v<T> ? json.is_number()
                                                    : json.is_string();
  return is_one ? std::optional<T>(json.get<T>()) : std::nullopt;
}

/// The number of that name, if within +-`most`.
inline std::optional<double> number(const Json& object, const char* name, double most) {
  const auto value = value_of<double>(member(object, name));
  return value && std::abs(*value) <= most ? value : std::nullopt;
}

/// The list of three numbers of that name, if its length is at most `most`.
inline std::optional<Vec3> vector(const Json& object, const char* name, double most) {
  const Json& list = member(object, name);
  if (!list.is_array() || list.size() != 3) return std::nullopt;
  Vec3 v;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto value = value_of<double>(list[axis]);
    if (!value) return std::nullopt;
    v[static_cast<Eigen::Index>(axis)] = *value;
  }
  return v.norm() <= most ? std::optional(v) : std::nullopt;
}

/// The text of that name; empty if there is none.
inline std::string text(const Json& object, const char* name) {
  return value_of<std::string>(member(object, name)).value_or("");
}

}  // namespace repel::fields
