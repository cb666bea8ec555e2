// SPDX-License-Identifier: BSD-3-Clause
#include "colors.hpp"

#include <algorithm>
#include <charconv>
#include <cstddef>

namespace repel::scene {
namespace {

constexpr std::array<std::string_view, 17> css_names{
    "aqua",  "black",  "blue",   "fuchsia", "gray",   "green", "lime",  "maroon", "navy",
    "olive", "orange", "purple", "red",     "silver", "teal",  "white", "yellow"};
constexpr std::array<unsigned, css_names.size()> css_values{
    0x00ffff, 0x000000, 0x0000ff, 0xff00ff, 0x808080, 0x008000, 0x00ff00, 0x800000, 0x000080,
    0x808000, 0xffa500, 0x800080, 0xff0000, 0xc0c0c0, 0x008080, 0xffffff, 0xffff00};

/// Of three bytes, red in the highest.
std::array<double, 3> shares_of(unsigned rgb) noexcept {
  return {(rgb >> 16U) / 255.0, (rgb >> 8U & 0xffU) / 255.0, (rgb & 0xffU) / 255.0};
}

}  // namespace

std::span<const std::string_view> color_names() noexcept {
  return css_names;
}

std::optional<std::array<double, 3>> color_of(std::string_view text) noexcept {
  const auto named = std::find(css_names.begin(), css_names.end(), text);
  if (named != css_names.end()) {
    return shares_of(css_values[static_cast<std::size_t>(named - css_names.begin())]);
  }
  if (text.size() != 7 || text.front() != '#') return std::nullopt;
  unsigned rgb = 0;
  const char* const last = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data() + 1, last, rgb, 16);
  if (error != std::errc{} || end != last) return std::nullopt;
  return shares_of(rgb);
}

}  // namespace repel::scene
