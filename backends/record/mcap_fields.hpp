// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Reads the fields of one record in order. Checks every length against the remaining bytes first.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>

#include "mcap_source.hpp"

namespace repel::record::detail {

class Fields {
 public:
  /// @param bytes rest of the record
  /// @param offset its position in the file
  Fields(const Source& source, std::string_view bytes, std::uint64_t offset)
      : source_(source), left_(bytes), offset_(offset) {}

  [[nodiscard]] std::uint64_t offset() const noexcept { return offset_; }
  [[nodiscard]] std::string_view left() const noexcept { return left_; }

  /// @throws SetupError naming the position of the field if it exceeds its record
  template <std::unsigned_integral T>
  [[nodiscard]] T number() {
    std::uint64_t value = 0;
    const std::string_view bytes = take(sizeof(T));
    for (std::size_t i = 0; i < sizeof(T); ++i) {
      value |= std::uint64_t{static_cast<std::uint8_t>(bytes[i])} << (8 * i);
    }
    return static_cast<T>(value);
  }

  /// The next `count` bytes. Throws as number() does, as do the following functions.
  [[nodiscard]] std::string_view take(std::uint64_t count);
  /// A string with a length prefix of four bytes.
  [[nodiscard]] std::string_view text() { return take(number<std::uint32_t>()); }
  /// A string with a length prefix of eight bytes.
  [[nodiscard]] std::string_view long_text() { return take(number<std::uint64_t>()); }
  /// Key-value pairs with a length prefix of four bytes, in bytes.
  [[nodiscard]] std::map<std::string, std::string> map();

 private:
  const Source& source_;
  std::string_view left_;
  std::uint64_t offset_;
};

}  // namespace repel::record::detail
