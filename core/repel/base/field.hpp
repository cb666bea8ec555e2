// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The numbers of an options struct, told once: from this come its checks, its keys in scene files
/// and their schema.
///
/// Such a struct has a static function that calls `visit(Field or Choice, x)` for each of them:
///
///     template <class Visit, class Options>
///     static constexpr void for_each_field(const Visit& visit, Options& options) {
///       visit(Field{"turning_time", "s", 0.0, 100.0}, options.turning_time);
///     }
#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <string>
#include <string_view>
#include <type_traits>

#include <repel/base/setup_error.hpp>

namespace repel {

/// A number, and what it may be.
struct Field {
  std::string_view name;     ///< its key in files; in messages with blanks for the underscores
  std::string_view unit;     ///< in SI; empty: none, and percent in files
  double low = 0.0;          ///< least value
  double high = 0.0;         ///< greatest value
  bool may_be_auto = false;  ///< or minus infinity, in files "auto": chosen for the arm
};

/// One of a few words, the names of the enumerators from 0 on.
struct Choice {
  std::string_view name;                  ///< its key in files
  std::array<std::string_view, 3> words;  ///< empty behind the last
};

/// Returns `options`. @throws SetupError for the first of its numbers that is out of range
template <class Options>
const Options& checked_fields(const Options& options) {
  const auto check = []<class Kind>(const Kind& field, const auto& value) {
    if constexpr (std::is_same_v<Kind, Field>) {
      const auto number = static_cast<double>(value);
      if (field.may_be_auto && number == -std::numeric_limits<double>::infinity()) return;
      std::string name(field.name);
      std::replace(name.begin(), name.end(), '_', ' ');
      checked(name, number, field.low, field.high, field.unit);
    }
  };
  Options::for_each_field(check, options);
  return options;
}

}  // namespace repel
