// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Strict access to YAML: every value knows its name and line; nothing is guessed or ignored.
#pragma once

#include <array>
#include <concepts>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <repel/base/setup_error.hpp>
#include <repel/base/types.hpp>
#include <repel/common/input_limits.hpp>
#include <repel/scene/change.hpp>

#include "key.hpp"
#include "units.hpp"
#include "yaml_document.hpp"

namespace repel::scene {

/// One value of a file. Its functions throw SetupError, naming file, line, value and what is
/// allowed, if it does not have the requested type or range.
class Value {
 public:
  Value(const Node& node, std::string name, std::shared_ptr<const Document> document)
      : node_(&node), line_(node.line), name_(std::move(name)), document_(std::move(document)) {}

  /// The root of the only document in a text, with other values in it.
  [[nodiscard]] static Value document(std::string_view yaml, const std::string& file,
                                      std::span<const Change> changes = {});

  /// Line in the file, from 1.
  [[nodiscard]] int line() const noexcept { return line_; }
  [[noreturn]] void fail(const std::string& what) const;
  [[noreturn]] void fail_with_value(const std::string& allowed) const;
  /// What `make` returns. An error without a line that it throws fails here, behind `what`.
  template <class Make>
  auto located(const Make& make, const std::string& what = {}) const {
    try {
      return make();
    } catch (const SetupError& error) {
      if (error.line() > 0) throw;
      fail(what + error.what());
    }
  }

  /// A non-empty scalar.
  [[nodiscard]] std::string text() const;
  /// The position of the text in `words`.
  [[nodiscard]] std::size_t index_in(std::span<const std::string_view> words) const;
  /// One of `words`.
  [[nodiscard]] std::string word_of(std::span<const std::string_view> words) const;
  [[nodiscard]] std::string word_of(std::initializer_list<std::string_view> words) const {
    return word_of(std::span<const std::string_view>(words.begin(), words.size()));
  }
  /// `yes` or `no`.
  [[nodiscard]] bool boolean() const { return word_of({"yes", "no"}) == "yes"; }
  /// The path of an existing file, which the text gives relative to the file of this value.
  [[nodiscard]] std::string path() const;
  /// The same of a folder.
  [[nodiscard]] std::string folder() const;
  /// The same of one folder, or of each in a list.
  [[nodiscard]] std::vector<std::string> folders() const;
  [[nodiscard]] std::int64_t integer(std::int64_t low, std::int64_t high) const;
  [[nodiscard]] double number(const Rule& rule) const;
  [[nodiscard]] Vec3 vector(const Rule& rule) const;
  [[nodiscard]] std::vector<double> numbers(const Rule& rule, std::size_t least,
                                            std::size_t most) const;
  /// Red, green, blue, sRGB, 0 to 1.
  [[nodiscard]] std::array<double, 3> color() const;
  [[nodiscard]] bool is_list() const { return node_->kind == Node::Kind::list; }
  /// The entries of a list with at most `most`.
  [[nodiscard]] std::vector<Value> list(std::size_t most = input_limits.entries) const;
  /// The same; of what is no list, the value itself.
  [[nodiscard]] std::vector<Value> one_or_list(std::size_t most = input_limits.entries) const {
    return is_list() ? list(most) : std::vector{*this};
  }

 private:
  friend class Map;
  [[nodiscard]] bool is_scalar() const { return node_->kind == Node::Kind::scalar; }

  const Node* node_;
  int line_;  // of the key if the value is empty, since it then has no position
  std::string name_;
  std::shared_ptr<const Document> document_;
};

/// A map of a file, with unique keys. Look-up takes logarithmic time.
class Map {
 public:
  /// @throws SetupError if it is no map or has more entries than input_limits allows
  explicit Map(const Value& value);
  /// Allows these keys alone. They must outlive the map.
  /// @throws SetupError likewise, and for any other key, suggesting the nearest
  Map(const Value& value, const Keys& keys);
  /// The same map, of these keys.
  [[nodiscard]] Map with(const Keys& keys) const;

  /// @throws SetupError for a key that is not in `keys`, suggesting the nearest
  void allow(const std::vector<std::string_view>& keys) const;
  /// Of a map with keys: allows all but these. @throws SetupError likewise
  void refuse(const std::vector<std::string_view>& keys) const;

  /// The value of `key`.
  ///
  /// @throws SetupError if it is missing
  [[nodiscard]] const Value& at(std::string_view key) const;
  /// The value of `key`; null if it is missing.
  [[nodiscard]] const Value* find(std::string_view key) const;

  /// Sets `out` if `key` is present. Of a map with keys: its type is that of the key.
  void read(std::string_view key, double& out) const;
  void read(std::string_view key, Vec3& out) const;
  void read(std::string_view key, std::string& out) const;
  void read(std::string_view key, bool& out) const;
  template <std::integral Integer>
  void read(std::string_view key, Integer& out) const {
    if (find(key) != nullptr) out = static_cast<Integer>(integer(key));
  }
  /// The words of the key are those of the enumerators from 0 on.
  template <class Word>
  requires std::is_enum_v<Word>
  void read(std::string_view key, Word& out) const {
    if (const Value* value = find(key)) out = static_cast<Word>(value->index_in(key_of(key).words));
  }
  /// The numbers and words of an options struct (repel/base/field.hpp).
  template <class Options>
  void read_fields(Options& options) const {
    Options::for_each_field([this](const auto& field, auto& x) { this->read(field.name, x); },
                            options);
  }

  /// The value of a key that is required. @throws SetupError if it is missing
  [[nodiscard]] double number(std::string_view key) const {
    return at(key).number(key_of(key).rule);
  }
  [[nodiscard]] Vec3 vector(std::string_view key) const { return at(key).vector(key_of(key).rule); }
  [[nodiscard]] std::int64_t integer(std::string_view key) const;
  [[nodiscard]] std::string_view word(std::string_view key) const {
    const Key& words = key_of(key);
    return words.words[at(key).index_in(words.words)];
  }

  [[nodiscard]] const std::vector<std::pair<std::string, Value>>& entries() const {
    return entries_;
  }

 private:
  [[nodiscard]] const Key& key_of(std::string_view name) const;

  Value self_;
  const Keys* keys_ = nullptr;
  std::vector<std::pair<std::string, Value>> entries_;
  std::map<std::string, std::size_t, std::less<>> index_;  // index of the entry by key
};

/// Adds the `name` of a map to `names`.
/// @throws SetupError if it is there already
void require_new(std::set<std::string>& names, const Map& map);

}  // namespace repel::scene
