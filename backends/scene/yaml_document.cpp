// SPDX-License-Identifier: BSD-3-Clause
#include "yaml_document.hpp"

#include <yaml.h>

#include <algorithm>
#include <map>
#include <utility>

#include <repel/base/setup_error.hpp>
#include <repel/common/input_limits.hpp>

namespace repel::scene {
namespace {

int line_at(std::string_view text, std::size_t offset) {
  const auto before = text.substr(0, offset);
  return 1 + static_cast<int>(std::count(before.begin(), before.end(), '\n'));
}

int line_of(const yaml_mark_t& mark) {
  return static_cast<int>(mark.line) + 1;
}

std::string_view text_of(const yaml_char_t* text) {
  return text == nullptr ? std::string_view() : reinterpret_cast<const char*>(text);
}

/// RAII wrapper of the libyaml parser; throws on errors.
class Events {
 public:
  Events(std::string_view text, const std::string& file) : text_(text), file_(file) {
    if (yaml_parser_initialize(&parser_) == 0) throw SetupError("no memory to read it", file);
    yaml_parser_set_input_string(&parser_, reinterpret_cast<const unsigned char*>(text.data()),
                                 text.size());
  }
  ~Events() {
    yaml_event_delete(&event_);
    yaml_parser_delete(&parser_);
  }
  Events(const Events&) = delete;
  Events& operator=(const Events&) = delete;

  /// The next event; valid until the next call.
  const yaml_event_t& next() {
    yaml_event_delete(&event_);
    if (yaml_parser_parse(&parser_, &event_) == 0) fail();
    return event_;
  }

 private:
  [[noreturn]] void fail() const {
    std::string what = "not YAML: ";
    what += parser_.problem == nullptr ? "no memory to read it" : parser_.problem;
    if (parser_.context != nullptr) {
      what.append(" ").append(parser_.context);
      // The colour of a part: what stands behind it is lost to the comment, the '}' with it.
      const std::string_view open = lines(parser_.context_mark.line, parser_.problem_mark.line);
      if (open.find(": #") != std::string_view::npos) {
        what += " from line " + std::to_string(line_of(parser_.context_mark)) +
                ", where a # begins a comment; allowed: \"#rrggbb\", in quotes";
      }
    }
    const int line = parser_.error == YAML_READER_ERROR ? line_at(text_, parser_.problem_offset)
                                                        : line_of(parser_.problem_mark);
    throw SetupError(what, file_, line);
  }

  /// Those from `first` up to `last`, from 0, without the latter.
  [[nodiscard]] std::string_view lines(std::size_t first, std::size_t last) const {
    std::size_t begin = 0;
    std::size_t end = 0;
    for (std::size_t line = 0; line < last && end < text_.size(); ++line) {
      if (line == first) begin = end;
      end = std::min(text_.find('\n', end), text_.size() - 1) + 1;
    }
    return text_.substr(begin, end - begin);
  }

  std::string_view text_;
  const std::string& file_;
  yaml_parser_t parser_{};
  yaml_event_t event_{};
};

/// Builds the tree of one document from its events.
class Builder {
 public:
  explicit Builder(Document& document) : document_(document) {}

  /// False at the end of the document.
  bool take(const yaml_event_t& event) {
    switch (event.type) {
      case YAML_SCALAR_EVENT:
        add_scalar(event);
        return true;
      case YAML_ALIAS_EVENT:
        add_alias(event);
        return true;
      case YAML_SEQUENCE_START_EVENT:
        open(event, Node::Kind::list, event.data.sequence_start.anchor);
        return true;
      case YAML_MAPPING_START_EVENT:
        open(event, Node::Kind::map, event.data.mapping_start.anchor);
        return true;
      case YAML_SEQUENCE_END_EVENT:
      case YAML_MAPPING_END_EVENT:
        close();
        return true;
      default:
        return false;
    }
  }

 private:
  [[noreturn]] void fail(const yaml_event_t& event, const std::string& what) const {
    throw SetupError(what, document_.file, line_of(event.start_mark));
  }

  Node& add(const yaml_event_t& event, const yaml_char_t* anchor) {
    count(event, 1);
    Node& node = document_.nodes.emplace_back();
    node.line = line_of(event.start_mark);
    if (anchor != nullptr) anchors_[checked_text(event, text_of(anchor))] = &node;
    attach(node);
    return node;
  }

  void add_scalar(const yaml_event_t& event) {
    const auto& scalar = event.data.scalar;
    const std::string text =
        checked_text(event, {reinterpret_cast<const char*>(scalar.value), scalar.length});
    Node& node = add(event, scalar.anchor);
    const bool plain = scalar.style == YAML_PLAIN_SCALAR_STYLE && scalar.tag == nullptr;
    const bool is_null =
        text.empty() || text == "~" || text == "null" || text == "Null" || text == "NULL";
    if (plain && is_null) return;
    node.kind = Node::Kind::scalar;
    node.text = text;
  }

  void add_alias(const yaml_event_t& event) {
    const std::string name = checked_text(event, text_of(event.data.alias.anchor));
    const auto found = anchors_.find(name);
    if (found == anchors_.end()) fail(event, "not YAML: no anchor '" + name + "' before this");
    const Node& node = *found->second;
    if (std::find(open_.begin(), open_.end(), &node) != open_.end()) {
      fail(event, "the alias '" + name + "' stands within what it stands for; allowed: behind it");
    }
    count(event, node.values);
    if (!open_.empty()) open_.back()->values += node.values - 1;
    attach(node);
  }

  void open(const yaml_event_t& event, Node::Kind kind, const yaml_char_t* anchor) {
    if (open_.size() == input_limits.depth) {
      fail(event, "lists and maps stand in each other more than " +
                      std::to_string(input_limits.depth) + " deep; allowed: up to " +
                      std::to_string(input_limits.depth));
    }
    Node& node = add(event, anchor);
    node.kind = kind;
    open_.push_back(&node);
  }

  void close() {
    const Node& node = *open_.back();
    open_.pop_back();
    if (!open_.empty()) open_.back()->values += node.values - 1;
  }

  /// Adds the node to the innermost open list or map, as one value.
  void attach(const Node& node) {
    if (open_.empty()) {
      document_.root = &node;
      return;
    }
    open_.back()->children.push_back(&node);
    ++open_.back()->values;
  }

  void count(const yaml_event_t& event, std::size_t values) {
    values_ += values;
    if (values_ <= input_limits.values) return;
    fail(event, "more than " + std::to_string(input_limits.values) +
                    " values, aliases written out; allowed: up to " +
                    std::to_string(input_limits.values));
  }

  [[nodiscard]] std::string checked_text(const yaml_event_t& event, std::string_view text) const {
    if (text.size() > input_limits.text_bytes) {
      fail(event, "a text of " + std::to_string(text.size()) + " bytes; allowed: up to " +
                      std::to_string(input_limits.text_bytes));
    }
    // It would end the name of a file and the message of an exception.
    if (text.find('\0') != std::string_view::npos) {
      fail(event, "a text with the character of code 0; allowed: text without it");
    }
    return std::string(text);
  }

  Document& document_;
  std::map<std::string, const Node*> anchors_;
  std::vector<Node*> open_;
  std::size_t values_ = 0;
};

/// Limits %TAG directives, because libyaml compares each one with all before it.
void require_few_directives(std::string_view text, const std::string& file) {
  std::size_t found = 0;
  for (std::size_t at = 0; at < text.size(); at = text.find_first_of("\r\n", at) + 1) {
    if (text[at] == '%' && ++found > input_limits.directives) {
      throw SetupError("more than " + std::to_string(input_limits.directives) +
                           " lines begin with '%'; allowed: up to " +
                           std::to_string(input_limits.directives),
                       file, line_at(text, at));
    }
    if (text.find_first_of("\r\n", at) == std::string_view::npos) return;
  }
}

}  // namespace

std::shared_ptr<const Document> read_yaml(std::string_view text, const std::string& file) {
  if (text.size() > input_limits.file_bytes) {
    throw SetupError("the scene has " + std::to_string(text.size()) + " bytes; allowed: up to " +
                         std::to_string(input_limits.file_bytes),
                     file);
  }
  require_few_directives(text, file);
  auto document = std::make_shared<Document>();
  document->file = file;
  Events events(text, file);
  (void)events.next();  // the start of the stream
  if (events.next().type == YAML_DOCUMENT_START_EVENT) {
    Builder builder(*document);
    while (builder.take(events.next())) continue;
    if (events.next().type == YAML_DOCUMENT_START_EVENT) {
      throw SetupError("a second YAML document; allowed: one scene in a file", file,
                       line_of(events.next().start_mark));
    }
  }
  if (document->root == nullptr || document->root->kind == Node::Kind::empty) {
    throw SetupError("the file is empty; allowed: one scene", file, 1);
  }
  return document;
}

}  // namespace repel::scene
