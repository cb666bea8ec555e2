// SPDX-License-Identifier: BSD-3-Clause
#include "mcap_fields.hpp"

#include <utility>

namespace repel::record::detail {

std::string_view Fields::take(std::uint64_t count) {
  if (count > left_.size()) {
    source_.fail(offset_, "a field of " + std::to_string(count) +
                              " bytes; allowed: up to the end of its record, " +
                              std::to_string(left_.size()) + " bytes");
  }
  const std::string_view taken = left_.substr(0, count);
  left_.remove_prefix(count);
  offset_ += count;
  return taken;
}

std::map<std::string, std::string> Fields::map() {
  const std::string_view bytes = text();
  Fields pairs(source_, bytes, offset_ - bytes.size());
  std::map<std::string, std::string> entries;
  while (!pairs.left().empty()) {
    std::string key(pairs.text());
    entries.insert_or_assign(std::move(key), std::string(pairs.text()));
  }
  return entries;
}

}  // namespace repel::record::detail
