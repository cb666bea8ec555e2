// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The keys of a map in a scene file and what each may hold. The readers and the schema go by them.
#pragma once

#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include <repel/base/field.hpp>

#include "units.hpp"

namespace repel::scene {

struct Key;
using Keys = std::vector<Key>;

/// One key of a map.
struct Key {
  /// What it holds.
  enum class Kind {
    number,   ///< and a unit, by `rule`
    integer,  ///< by `rule`
    vector,   ///< three numbers and a unit
    flag,     ///< yes or no
    text,
    word,   ///< one of `words`
    texts,  ///< a text, or a list of texts
    color,  ///< a name or "#rrggbb"
    map,    ///< with `keys`
    maps,   ///< a list of maps with `keys`
    named,  ///< a map from names to maps with `keys`
    any,    ///< what only its reader can say
  };

  std::string_view name;
  Kind kind = Kind::any;
  Rule rule{};
  std::vector<std::string_view> words{};
  const Keys* keys = nullptr;
  bool is_required = false;

  /// The same, without which a map is refused.
  [[nodiscard]] Key required() && {
    is_required = true;
    return std::move(*this);
  }
};

namespace key {
inline constexpr double most_seed = 1e9;

[[nodiscard]] inline Key number(std::string_view name, Units units, double low, double high) {
  return {name, Key::Kind::number, {units, low, high}};
}
[[nodiscard]] inline Key integer(std::string_view name, double low, double high) {
  return {name, Key::Kind::integer, {unit::none, low, high}};
}
[[nodiscard]] inline Key vector(std::string_view name, const Rule& rule) {
  return {name, Key::Kind::vector, rule};
}
[[nodiscard]] inline Key flag(std::string_view name) {
  return {name, Key::Kind::flag};
}
[[nodiscard]] inline Key text(std::string_view name) {
  return {name, Key::Kind::text};
}
[[nodiscard]] inline Key texts(std::string_view name) {
  return {name, Key::Kind::texts};
}
[[nodiscard]] inline Key color(std::string_view name) {
  return {name, Key::Kind::color};
}
[[nodiscard]] inline Key any(std::string_view name) {
  return {name};
}
[[nodiscard]] inline Key word(std::string_view name, std::vector<std::string_view> words) {
  return {name, Key::Kind::word, {}, std::move(words)};
}
[[nodiscard]] inline Key map(std::string_view name, const Keys& keys) {
  return {name, Key::Kind::map, {}, {}, &keys};
}
[[nodiscard]] inline Key maps(std::string_view name, const Keys& keys) {
  return {name, Key::Kind::maps, {}, {}, &keys};
}

/// The numbers and words of an options struct, behind `keys` and before `after`.
template <class Options>
[[nodiscard]] Keys fields(Keys keys = {}, const Keys& after = {}) {
  Options options{};
  const auto append = [&]<class Entry>(const Entry& entry, const auto& /*value*/) {
    if constexpr (std::is_same_v<Entry, Field>) {
      const Units units = entry.unit.empty() ? Units(unit::share) : unit::of_dimension(entry.unit);
      keys.push_back({entry.name,
                      Key::Kind::number,
                      {.units = units,
                       .low = entry.low,
                       .high = entry.high,
                       .may_be_auto = entry.may_be_auto}});
    } else {
      Key& key = keys.emplace_back(Key{entry.name, Key::Kind::word});
      for (const std::string_view word : entry.words) {
        if (!word.empty()) key.words.push_back(word);
      }
    }
  };
  Options::for_each_field(append, options);
  keys.insert(keys.end(), after.begin(), after.end());
  return keys;
}
}  // namespace key

}  // namespace repel::scene
