// SPDX-License-Identifier: BSD-3-Clause
#include <string>
#include <string_view>
#include <vector>

#include <repel/base/setup_error.hpp>
#include <repel/scene/scene.hpp>

#include "colors.hpp"
#include "grammar.hpp"

namespace repel::scene {
namespace {

std::string json(std::string_view text) {
  std::string result(1, '"');
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += c;
  }
  return result + '"';
}

/// A list in brackets, or an object in braces.
std::string enclosed(char open, const std::vector<std::string>& entries, char close) {
  std::string text(1, open);
  for (const std::string& entry : entries) {
    if (text.size() > 1) text += ',';
    text += entry;
  }
  return text + close;
}

std::string strings(const std::vector<std::string_view>& words) {
  std::vector<std::string> entries;
  for (const std::string_view word : words) entries.push_back(json(word));
  return enclosed('[', entries, ']');
}

/// So many numbers, and one of the units.
std::string quantity_pattern(const std::string& repeated, Units units) {
  const std::string number = R"([-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?)";
  std::string pattern = "^" + number + "(\\s+" + number + ")" + repeated;
  std::string names;
  bool is_needed = true;
  for (const Unit& unit : units) {
    is_needed = is_needed && !unit.name.empty();
    if (unit.name.empty()) continue;
    names += names.empty() ? "" : "|";
    for (const char c : unit.name) names += c == '^' ? std::string("\\^") : std::string(1, c);
  }
  if (!names.empty()) pattern += "\\s*(" + names + ")" + (is_needed ? "" : "?");
  return json(pattern + "$");
}

std::string quantity(const Rule& rule, const std::string& repeated) {
  const std::string units = units_text(rule.units);
  const std::string text =
      "{\"type\":\"string\",\"pattern\":" + quantity_pattern(repeated, rule.units) +
      ",\"description\":" +
      json(range_text(rule) + (rule.units.size() > 1 ? ", in " + units : "")) + "}";
  std::vector<std::string> alternatives{text};
  if (rule.may_be_auto) alternatives.emplace_back("{\"const\":\"auto\"}");
  const bool is_plain = repeated == "{0}" && rule.units.front().name.empty();
  if (is_plain) {
    alternatives.push_back("{\"type\":\"number\",\"minimum\":" + to_text(rule.low) +
                           ",\"maximum\":" + to_text(rule.high) + "}");
  }
  if (alternatives.size() == 1) return text;
  return "{\"anyOf\":" + enclosed('[', alternatives, ']') + "}";
}

std::string object(const Keys& keys);

/// An entry of `network`: its `module` says which keys it may have.
std::string any_module() {
  std::vector<std::string_view> words;
  std::vector<std::string> cases;
  for (const grammar::ModuleKind& kind : grammar::module_kinds()) {
    words.push_back(kind.word);
    cases.push_back(R"({"if":{"properties":{"module":{"const":)" + json(kind.word) +
                    R"(}}},"then":)" + object(kind.keys) + "}");
  }
  return R"({"type":"object","required":["module"],"properties":{"module":{"enum":)" +
         strings(words) + R"(}},"allOf":)" + enclosed('[', cases, ']') + "}";
}

std::string of(const Key& key) {
  const std::string texts = R"({"type":"array","items":{"type":"string"}})";
  switch (key.kind) {
    case Key::Kind::number:
      return quantity(key.rule, "{0}");
    case Key::Kind::vector:
      return quantity(key.rule, "{2}");
    case Key::Kind::integer:
      return R"({"type":"integer","minimum":)" + to_text(key.rule.low) + R"(,"maximum":)" +
             to_text(key.rule.high) + "}";
    case Key::Kind::flag:
      return R"({"enum":["yes","no"]})";
    case Key::Kind::text:
      return R"({"type":["string","number"]})";
    case Key::Kind::word:
      return "{\"enum\":" + strings(key.words) + "}";
    case Key::Kind::texts:
      return R"({"anyOf":[{"type":"string"},)" + texts + "]}";
    case Key::Kind::color:
      return R"({"anyOf":[{"type":"string","pattern":"^#[0-9a-fA-F]{6}$"},{"enum":)" +
             strings({color_names().begin(), color_names().end()}) + "}]}";
    case Key::Kind::map:
      return object(*key.keys);
    case Key::Kind::maps:
      return R"({"type":"array","items":)" +
             (key.keys == &grammar::any_module() ? any_module() : object(*key.keys)) + "}";
    case Key::Kind::named:
      return R"({"type":"object","additionalProperties":)" + object(*key.keys) + "}";
    case Key::Kind::any:
      return "{}";
  }
  return "{}";
}

std::string object(const Keys& keys) {
  std::vector<std::string> properties;
  std::vector<std::string_view> required;
  for (const Key& key : keys) {
    properties.push_back(json(key.name) + ":" + of(key));
    if (key.is_required) required.push_back(key.name);
  }
  return R"({"type":"object","additionalProperties":false,"required":)" + strings(required) +
         R"(,"properties":)" + enclosed('{', properties, '}') + "}";
}

}  // namespace

std::string schema() {
  std::string text = object(grammar::scene());
  return text.insert(1, R"("$schema":"http://json-schema.org/draft-07/schema#",)"
                        R"("title":"A scene of repel",)");
}

}  // namespace repel::scene
