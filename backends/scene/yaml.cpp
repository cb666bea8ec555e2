// SPDX-License-Identifier: BSD-3-Clause
// libyaml parses; by hand are lines, ranges and allowed keys, which no library adds to it.
#include "yaml.hpp"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <numeric>
#include <stdexcept>

#include <repel/network/elements/robot_end.hpp>

#include "changed.hpp"
#include "colors.hpp"

namespace repel::scene {
namespace {

std::string in_quotes(std::string_view text) {
  std::string result(1, '\'');
  return result.append(text).append(1, '\'');
}

/// Joins words: "a, b, c".
std::string listed(std::span<const std::string_view> words) {
  std::string text;
  for (const std::string_view word : words) {
    if (!text.empty()) text += ", ";
    text += word;
  }
  return text;
}

/// Levenshtein distance: insertions, deletions and replacements from `a` to `b`.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i + 1);
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row.back();
}

/// A text as shown in errors: quoted and truncated.
std::string shown(const std::string& text) {
  constexpr std::size_t most = 200;
  return text.size() <= most
             ? in_quotes(text)
             : in_quotes(text.substr(0, most)) + "... (" + std::to_string(text.size()) + " bytes)";
}

/// The path of what `value` names relative to `file`, a regular file or a directory as `type` says.
std::string existing(const Value& value, const std::string& file, std::filesystem::file_type type) {
  const auto path = std::filesystem::path(file).parent_path() / value.text();
  std::string normal = path.lexically_normal().string();
  std::error_code unused;
  if (std::filesystem::status(path, unused).type() != type) {
    const bool is_folder = type == std::filesystem::file_type::directory;
    value.fail_with_value((is_folder ? "a folder" : "a file") + ("; there is none at " + normal));
  }
  return normal;
}

}  // namespace

Value Value::document(std::string_view yaml, const std::string& file,
                      std::span<const Change> changes) {
  auto document = changed(read_yaml(yaml, file), changes);
  const Node& root = *document->root;
  return {root, "the scene", std::move(document)};
}

void Value::fail(const std::string& what) const {
  throw SetupError(what, document_->file, line_);
}

void Value::fail_with_value(const std::string& allowed) const {
  const std::string found = is_scalar()                       ? shown(node_->text)
                            : node_->kind == Node::Kind::map  ? "a map"
                            : node_->kind == Node::Kind::list ? "a list"
                                                              : "empty";
  fail(in_quotes(name_) + " is " + found + "; allowed: " + allowed);
}

std::string Value::text() const {
  if (!is_scalar() || node_->text.empty()) fail_with_value("a text");
  return node_->text;
}

std::size_t Value::index_in(std::span<const std::string_view> words) const {
  const auto found = is_scalar() ? std::find(words.begin(), words.end(), node_->text) : words.end();
  if (found == words.end()) fail_with_value(listed(words));
  return static_cast<std::size_t>(found - words.begin());
}

std::string Value::word_of(std::span<const std::string_view> words) const {
  return std::string(words[index_in(words)]);
}

std::string Value::path() const {
  return existing(*this, document_->file, std::filesystem::file_type::regular);
}

std::string Value::folder() const {
  return existing(*this, document_->file, std::filesystem::file_type::directory);
}

std::vector<std::string> Value::folders() const {
  std::vector<std::string> folders;
  for (const Value& each : one_or_list()) folders.push_back(each.folder());
  return folders;
}

std::int64_t Value::integer(std::int64_t low, std::int64_t high) const {
  const std::string& digits = node_->text;
  const char* const last = digits.data() + digits.size();
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(digits.data(), last, value);
  if (error != std::errc{} || end != last || value < low || value > high) {
    fail_with_value("a whole number, " + std::to_string(low) + " to " + std::to_string(high));
  }
  return value;
}

double Value::number(const Rule& rule) const {
  if (rule.may_be_auto && node_->text == "auto") return network::automatic;
  return numbers(rule, 1, 1).front();
}

std::vector<double> Value::numbers(const Rule& rule, std::size_t least, std::size_t most) const {
  const auto values = quantity(node_->text, rule.units);
  if (!values || values->size() < least || values->size() > most) {
    const std::string count = least == most ? std::to_string(most)
                                            : std::to_string(least) + " to " + std::to_string(most);
    const bool is_bare = rule.units.front().name.empty();
    fail_with_value(count + (most == 1 ? " number, " : " numbers, ") +
                    (is_bare ? "no unit" : "then the unit ") + units_text(rule.units) + "; " +
                    range_text(rule));
  }
  for (const double value : *values) {
    if (!obeys(value, rule)) fail_with_value(range_text(rule));
  }
  return *values;
}

Vec3 Value::vector(const Rule& rule) const {
  const auto values = numbers(rule, 3, 3);
  return {values[0], values[1], values[2]};
}

std::array<double, 3> Value::color() const {
  const auto color = is_scalar() ? color_of(node_->text) : std::nullopt;
  if (!color) fail_with_value("\"#rrggbb\", in quotes, " + listed(color_names()));
  return *color;
}

std::vector<Value> Value::list(std::size_t most) const {
  if (!is_list()) fail_with_value("a list");
  const auto& nodes = node_->children;
  if (nodes.size() > most) {
    fail(in_quotes(name_) + " has " + std::to_string(nodes.size()) + " entries; allowed: up to " +
         std::to_string(most));
  }
  std::vector<Value> entries;
  entries.reserve(nodes.size());
  for (const Node* node : nodes) {
    entries.emplace_back(*node, name_ + "[" + std::to_string(entries.size()) + "]", document_);
  }
  return entries;
}

Map::Map(const Value& value) : self_(value) {
  if (value.node_->kind != Node::Kind::map) value.fail_with_value("a map");
  const auto& nodes = value.node_->children;
  if (nodes.size() / 2 > input_limits.entries) {
    value.fail(in_quotes(value.name_) + " has " + std::to_string(nodes.size() / 2) +
               " entries; allowed: up to " + std::to_string(input_limits.entries));
  }
  for (std::size_t i = 0; i < nodes.size(); i += 2) {
    const Value key(*nodes[i], "key", value.document_);
    const std::string name = key.text();
    if (!index_.emplace(name, entries_.size()).second) {
      key.fail("a second key " + shown(name) + "; allowed: one");
    }
    entries_.emplace_back(name, Value(*nodes[i + 1], name, value.document_));
    if (nodes[i + 1]->kind == Node::Kind::empty) entries_.back().second.line_ = key.line_;
  }
}

Map::Map(const Value& value, const Keys& keys) : Map(value) {
  keys_ = &keys;
  refuse({});
}

Map Map::with(const Keys& keys) const {
  return {self_, keys};
}

void Map::refuse(const std::vector<std::string_view>& keys) const {
  std::vector<std::string_view> others;
  for (const Key& key : *keys_) {
    if (std::find(keys.begin(), keys.end(), key.name) == keys.end()) others.push_back(key.name);
  }
  allow(others);
}

void Map::allow(const std::vector<std::string_view>& keys) const {
  const auto& nodes = self_.node_->children;
  for (std::size_t i = 0; i < nodes.size(); i += 2) {
    const std::string& found = nodes[i]->text;
    if (std::find(keys.begin(), keys.end(), found) != keys.end()) continue;
    const auto nearer = [&](std::string_view a, std::string_view b) {
      return edit_distance(found, a) < edit_distance(found, b);
    };
    const std::string_view nearest = *std::min_element(keys.begin(), keys.end(), nearer);
    const bool near = edit_distance(found, nearest) <= 1 + nearest.size() / 3;
    Value(*nodes[i], found, self_.document_)
        .fail("unknown key " + shown(found) +
              (near ? "; did you mean " + in_quotes(nearest) + "?" : ";") +
              " allowed: " + listed(keys));
  }
}

const Value& Map::at(std::string_view key) const {
  const Value* value = find(key);
  if (!value) self_.fail("the key " + in_quotes(key) + " is missing in " + in_quotes(self_.name_));
  return *value;
}

const Value* Map::find(std::string_view key) const {
  const auto found = index_.find(key);
  return found == index_.end() ? nullptr : &entries_[found->second].second;
}

const Key& Map::key_of(std::string_view name) const {
  for (const Key& key : *keys_) {
    if (key.name == name) return key;
  }
  throw std::logic_error("no key '" + std::string(name) + "' in the grammar of this map");
}

std::int64_t Map::integer(std::string_view key) const {
  const Rule& rule = key_of(key).rule;
  return at(key).integer(static_cast<std::int64_t>(rule.low), static_cast<std::int64_t>(rule.high));
}

void Map::read(std::string_view key, double& out) const {
  if (find(key) != nullptr) out = number(key);
}

void Map::read(std::string_view key, Vec3& out) const {
  if (find(key) != nullptr) out = vector(key);
}

void Map::read(std::string_view key, std::string& out) const {
  if (const Value* value = find(key)) out = value->text();
}

void Map::read(std::string_view key, bool& out) const {
  if (const Value* value = find(key)) out = value->boolean();
}

void require_new(std::set<std::string>& names, const Map& map) {
  const Value& name = map.at("name");
  if (!names.insert(name.text()).second) name.fail_with_value("a name no other entry has");
}

}  // namespace repel::scene
