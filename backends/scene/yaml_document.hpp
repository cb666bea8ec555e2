// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Parses YAML text to a tree, within the limits of input_limits.hpp for any input.
#pragma once

#include <cstddef>
#include <deque>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace repel::scene {

/// One value of a file.
struct Node {
  enum class Kind { empty, scalar, list, map };

  Kind kind = Kind::empty;
  int line = 0;                       ///< in the file, from 1
  std::string text;                   ///< of a scalar
  std::vector<const Node*> children;  ///< of a list; of a map, key and value alternately
  std::size_t values = 1;             ///< itself and all values below it, with aliases expanded
};

/// The tree of a file. Aliased nodes are stored once.
struct Document {
  std::string file;
  const Node* root = nullptr;
  std::deque<Node> nodes;
  std::vector<std::shared_ptr<const Document>> others;  ///< that have nodes of this tree
};

/// Reads the only document of a text. Memory and time are linear in the length of the text, up to
/// the limits.
/// @throws SetupError naming file and line, if it is not YAML, empty, has more than one document or
///   exceeds the limits
[[nodiscard]] std::shared_ptr<const Document> read_yaml(std::string_view text,
                                                        const std::string& file);

}  // namespace repel::scene
