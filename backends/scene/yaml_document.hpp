/// @file
/// A text of YAML as a tree, read within the limits of input_limits.hpp whatever the text.
#pragma once

#include <cstddef>
#include <deque>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace repel::scene {

/// One value of a file as it stands there.
struct Node {
  enum class Kind { empty, scalar, list, map };

  Kind kind = Kind::empty;
  int line = 0;                       ///< of the file, from 1
  std::string text;                   ///< of a scalar
  std::vector<const Node*> children;  ///< of a list; of a map key and value in turn
  std::size_t values = 1;             ///< itself and all in it, aliases written out
};

/// The tree of a file. Values under an alias stand in it once.
struct Document {
  std::string file;
  const Node* root = nullptr;
  std::deque<Node> nodes;
};

/// Reads the only document of a text. Memory and time grow with the length of the text, up to the
/// limits. Throws SetupError naming file and line when it is not YAML, empty, more than one
/// document, or more than the limits allow.
[[nodiscard]] std::shared_ptr<const Document> read_yaml(std::string_view text,
                                                        const std::string& file);

}  // namespace repel::scene
