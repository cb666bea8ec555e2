#include "yaml.hpp"

#include <algorithm>
#include <charconv>
#include <numeric>

#include <repel/base/setup_error.hpp>

namespace repel::scene {
namespace {

std::string in_quotes(std::string_view text) {
  std::string result(1, '\'');
  return result.append(text).append(1, '\'');
}

/// "a, b, c"
std::string listed(std::span<const std::string_view> words) {
  std::string text;
  for (const std::string_view word : words) {
    if (!text.empty()) text += ", ";
    text += word;
  }
  return text;
}

/// Letters to insert, delete or replace to get from `a` to `b`.
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

int line_of(const YAML::Mark& mark) {
  return mark.is_null() ? 0 : mark.line + 1;
}

}  // namespace

Value Value::document(std::string_view yaml, const std::string& file) {
  try {
    const auto documents = YAML::LoadAll(std::string(yaml));
    if (documents.empty() || documents.front().IsNull()) {
      throw SetupError("the file is empty; allowed: one scene", file, 1);
    }
    Value first(documents.front(), "the scene", std::make_shared<std::string>(file));
    if (documents.size() > 1) {
      const Value second(documents[1], "", first.file_);
      second.fail("a second YAML document; allowed: one scene in a file");
    }
    return first;
  } catch (const YAML::Exception& error) {
    throw SetupError("not YAML: " + error.msg, file, line_of(error.mark));
  }
}

void Value::fail(const std::string& what) const {
  throw SetupError(what, *file_, line_of(mark_));
}

void Value::fail_with_value(const std::string& allowed) const {
  const std::string found = node_.IsScalar()     ? in_quotes(node_.Scalar())
                            : node_.IsMap()      ? "a map"
                            : node_.IsSequence() ? "a list"
                                                 : "empty";
  fail(in_quotes(name_) + " is " + found + "; allowed: " + allowed);
}

std::string Value::text() const {
  if (!node_.IsScalar() || node_.Scalar().empty()) fail_with_value("a text");
  return node_.Scalar();
}

std::string Value::word_of(std::initializer_list<std::string_view> words) const {
  const bool known =
      node_.IsScalar() && std::find(words.begin(), words.end(), node_.Scalar()) != words.end();
  if (!known) fail_with_value(listed({words.begin(), words.size()}));
  return node_.Scalar();
}

std::int64_t Value::integer(std::int64_t low, std::int64_t high) const {
  const std::string digits = node_.IsScalar() ? node_.Scalar() : "";
  const char* const last = digits.data() + digits.size();
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(digits.data(), last, value);
  if (error != std::errc{} || end != last || value < low || value > high) {
    fail_with_value("a whole number, " + std::to_string(low) + " to " + std::to_string(high));
  }
  return value;
}

std::vector<double> Value::numbers(const Rule& rule, std::size_t least, std::size_t most) const {
  const auto values =
      quantity(node_.IsScalar() ? std::string_view(node_.Scalar()) : "", rule.units);
  if (!values || values->size() < least || values->size() > most) {
    const std::string count = least == most ? std::to_string(most)
                                            : std::to_string(least) + " to " + std::to_string(most);
    const std::string units = units_text(rule.units);
    fail_with_value(count + (most == 1 ? " number" : " numbers") +
                    (units.empty() ? ", no unit" : ", then the unit " + units));
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

std::vector<Value> Value::list() const {
  if (!node_.IsSequence()) fail_with_value("a list");
  std::vector<Value> entries;
  entries.reserve(node_.size());
  for (const auto& node : node_) {
    entries.emplace_back(node, name_ + "[" + std::to_string(entries.size()) + "]", file_);
  }
  return entries;
}

Map::Map(const Value& value) : self_(value) {
  if (!value.node_.IsMap()) value.fail_with_value("a map");
  for (const auto& entry : value.node_) {
    const Value key(entry.first, "key", value.file_);
    const std::string name = key.text();
    if (find(name)) key.fail("a second key " + in_quotes(name) + "; allowed: one");
    entries_.emplace_back(name, Value(entry.second, name, value.file_));
    if (entry.second.IsNull()) entries_.back().second.mark_ = key.mark_;
  }
}

void Map::allow(std::span<const std::string_view> keys) const {
  for (const auto& entry : self_.node_) {
    const std::string& found = entry.first.Scalar();
    if (std::find(keys.begin(), keys.end(), found) != keys.end()) continue;
    const auto nearer = [&](std::string_view a, std::string_view b) {
      return edit_distance(found, a) < edit_distance(found, b);
    };
    const std::string_view nearest = *std::min_element(keys.begin(), keys.end(), nearer);
    const bool near = edit_distance(found, nearest) <= 1 + nearest.size() / 3;
    Value(entry.first, found, self_.file_)
        .fail("unknown key " + in_quotes(found) +
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
  for (const auto& [name, value] : entries_) {
    if (name == key) return &value;
  }
  return nullptr;
}

void Map::read(std::string_view key, const Rule& rule, double& out) const {
  if (const Value* value = find(key)) out = value->number(rule);
}

void Map::read(std::string_view key, const Rule& rule, Vec3& out) const {
  if (const Value* value = find(key)) out = value->vector(rule);
}

void Map::read(std::string_view key, std::string& out) const {
  if (const Value* value = find(key)) out = value->text();
}

}  // namespace repel::scene
