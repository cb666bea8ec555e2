// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Mutates a text as a hostile or careless author might: keywords in wrong places, pieces omitted,
/// duplicated or swapped.
#pragma once

#include <algorithm>
#include <cstddef>
#include <random>
#include <span>
#include <string>
#include <string_view>

namespace repel::fuzz {

/// `text` after 1 to 8 mutations; `words` [not empty] are inserted.
inline std::string mutated(std::string text, std::mt19937_64& rng,
                           std::span<const std::string_view> words) {
  const auto below = [&](std::size_t count) { return count == 0 ? 0 : rng() % count; };
  for (std::size_t changes = 1 + below(8); changes > 0; --changes) {
    const std::size_t at = below(text.size() + 1);
    const std::size_t length = std::min(text.size() - at, below(4) == 0 ? below(400) : below(12));
    switch (below(6)) {
      case 0:
        text.erase(at, length);
        break;
      case 1:
        text.insert(below(text.size() + 1), text.substr(at, length));
        break;
      case 2:
        if (at < text.size()) text[at] = static_cast<char>(rng());
        break;
      case 3:
        text.replace(at, length, words[below(words.size())]);
        break;
      case 4: {
        std::string many;
        const std::string_view word = words[below(words.size())];
        for (std::size_t i = below(200); i > 0; --i) many += word;
        text.insert(at, many);
        break;
      }
      default:
        text.insert(at, words[below(words.size())]);
    }
  }
  return text;
}

}  // namespace repel::fuzz
