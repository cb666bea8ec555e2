// SPDX-License-Identifier: BSD-3-Clause
#include "changed.hpp"

#include <charconv>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <repel/base/setup_error.hpp>

namespace repel::scene {
namespace {

/// The first words of a path, and what is left of it.
struct Step {
  std::string_view name;
  std::string_view rest;
};

/// The ways to take a step, the longest name first: a name may have dots of its own.
std::vector<Step> steps_of(std::string_view path) {
  std::vector<Step> steps{{path, {}}};
  for (std::size_t at = path.rfind('.'); at != std::string_view::npos && at > 0;
       at = path.rfind('.', at - 1)) {
    steps.push_back({path.substr(0, at), path.substr(at + 1)});
  }
  return steps;
}

std::optional<std::size_t> number_of(std::string_view text) {
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return {};
  return number;
}

/// What an entry of a list is called: its name, or the module that it is.
std::string_view name_of(const Node& entry) {
  std::string_view found;
  if (entry.kind != Node::Kind::map) return found;
  for (std::size_t i = 0; i + 1 < entry.children.size(); i += 2) {
    const std::string& key = entry.children[i]->text;
    if (key == "name" || (key == "module" && found.empty())) found = entry.children[i + 1]->text;
  }
  return found;
}

/// One change of a document that is not shared yet.
class Changer {
 public:
  Changer(Document& document, const Change& change) : document_(document), change_(change) {
    // Read by itself, so that it may be a list or a map as well.
    value_ = change.value.empty() ? nullptr : read_yaml(change.value, document.file);
  }

  void change() { document_.root = changed(*document_.root, change_.path); }

 private:
  [[noreturn]] void fail(const Node& at, const std::string& what) const {
    throw SetupError("the path '" + change_.path + "' " + what, document_.file, at.line);
  }

  /// A copy of the node, with the value at the path below it.
  const Node* changed(const Node& node, std::string_view path) {
    switch (node.kind) {
      case Node::Kind::map:
        return changed_map(node, path);
      case Node::Kind::list:
        return changed_list(node, path);
      case Node::Kind::scalar:
        return changed_text(node, path);
      case Node::Kind::empty:
        break;
    }
    return with_entry(copy_of(node), path);
  }

  const Node* changed_map(const Node& map, std::string_view path) {
    for (const Step& step : steps_of(path)) {
      for (std::size_t i = 0; i + 1 < map.children.size(); i += 2) {
        if (map.children[i]->text == step.name) return with_child(map, i + 1, step.rest);
      }
    }
    return with_entry(copy_of(map), path);
  }

  const Node* changed_list(const Node& list, std::string_view path) {
    for (const Step& step : steps_of(path)) {
      for (std::size_t i = 0; i < list.children.size(); ++i) {
        if (name_of(*list.children[i]) == step.name) return with_child(list, i, step.rest);
      }
      const auto number = number_of(step.name);
      if (number && *number < list.children.size()) return with_child(list, *number, step.rest);
    }
    std::string names;
    for (const Node* entry : list.children) {
      const std::string_view name = name_of(*entry);
      if (!name.empty()) names.append(names.empty() ? "" : ", ").append(name);
    }
    fail(list, "names no entry of the list in this line by '" + std::string(path) +
                   "'; allowed: a number below " + std::to_string(list.children.size()) +
                   (names.empty() ? "" : ", or one of " + names));
  }

  /// One number of a row, in its unit: the second of "0 45 -180 deg" is `1`.
  const Node* changed_text(const Node& row, std::string_view path) {
    std::vector<std::pair<std::size_t, std::size_t>> numbers;  // begin and end
    const std::string& text = row.text;
    for (std::size_t begin = text.find_first_not_of(' '); begin != std::string::npos;) {
      const std::size_t end = std::min(text.find(' ', begin), text.size());
      double unused = 0.0;
      const char* const first = text.data() + begin;
      if (std::from_chars(first, text.data() + end, unused).ptr != text.data() + end) break;
      numbers.emplace_back(begin, end);
      begin = text.find_first_not_of(' ', end);
    }
    const auto number = number_of(path);
    if (!number || *number >= numbers.size()) {
      fail(row, "leads into '" + text + "' by '" + std::string(path) + "'; allowed: " +
                    (numbers.empty() ? std::string("a path that ends before it")
                                     : "a number below " + std::to_string(numbers.size()) +
                                           ", for one of its"));
    }
    Node& copy = copy_of(row);
    const auto [begin, end] = numbers[*number];
    copy.text = text.substr(0, begin) + change_.value + text.substr(end);
    return &copy;
  }

  Node& copy_of(const Node& node) { return document_.nodes.emplace_back(node); }

  const Node* with_child(const Node& node, std::size_t i, std::string_view path) {
    const Node* const before = node.children[i];
    const Node* const after = path.empty() ? value_at(*before) : changed(*before, path);
    Node& copy = copy_of(node);
    copy.children[i] = after;
    copy.values += after->values - before->values;
    return &copy;
  }

  /// A map with one more entry; the path to it makes maps on its way.
  const Node* with_entry(Node& map, std::string_view path) {
    const std::size_t dot = path.find('.');
    const int line = map.line;
    map.kind = Node::Kind::map;
    Node& key = document_.nodes.emplace_back();
    key.kind = Node::Kind::scalar;
    key.line = line;
    key.text = path.substr(0, dot);
    const Node* value = nullptr;
    if (dot == std::string_view::npos) {
      value = value_at(map);
    } else {
      Node& below = document_.nodes.emplace_back();
      below.line = line;
      value = with_entry(below, path.substr(dot + 1));
    }
    map.children.push_back(&key);
    map.children.push_back(value);
    map.values += 1 + value->values;
    return &map;
  }

  /// The new value, in the line of what was there.
  const Node* value_at(const Node& before) {
    Node& copy = value_ ? copy_of(*value_->root) : document_.nodes.emplace_back();
    copy.line = before.line;
    if (value_) document_.others.push_back(value_);
    return &copy;
  }

  Document& document_;
  const Change& change_;
  std::shared_ptr<const Document> value_;
};

}  // namespace

std::shared_ptr<const Document> changed(std::shared_ptr<const Document> document,
                                        std::span<const Change> changes) {
  if (changes.empty()) return document;
  auto result = std::make_shared<Document>();
  result->file = document->file;
  result->root = document->root;
  result->others.push_back(std::move(document));
  for (const Change& change : changes) {
    if (change.path.empty() || change.path.front() == '.' || change.path.back() == '.') {
      throw SetupError("the path '" + change.path +
                           "' has no name at an end; allowed: names with dots between them, as "
                           "laws.wall.damping",
                       result->file);
    }
    Changer(*result, change).change();
  }
  return result;
}

}  // namespace repel::scene
