/// @file
/// The fields of one record, in their order. Lengths are compared with what is there before any
/// byte is taken.
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
  /// @param bytes what is left of the record
  /// @param offset where that stands in the file
  Fields(const Source& source, std::string_view bytes, std::uint64_t offset)
      : source_(source), left_(bytes), offset_(offset) {}

  [[nodiscard]] std::uint64_t offset() const noexcept { return offset_; }
  [[nodiscard]] std::string_view left() const noexcept { return left_; }

  /// @throws SetupError naming the place of the field when the record ends before the field does
  template <std::unsigned_integral T>
  [[nodiscard]] T number() {
    std::uint64_t value = 0;
    const std::string_view bytes = take(sizeof(T));
    for (std::size_t i = 0; i < sizeof(T); ++i) {
      value |= std::uint64_t{static_cast<std::uint8_t>(bytes[i])} << (8 * i);
    }
    return static_cast<T>(value);
  }

  /// So many bytes. Throws as number() does, as do the following.
  [[nodiscard]] std::string_view take(std::uint64_t count);
  /// With four bytes of length before them.
  [[nodiscard]] std::string_view text() { return take(number<std::uint32_t>()); }
  /// With eight bytes of length before them.
  [[nodiscard]] std::string_view long_text() { return take(number<std::uint64_t>()); }
  /// With four bytes of length, in bytes, before the pairs.
  [[nodiscard]] std::map<std::string, std::string> map();

 private:
  const Source& source_;
  std::string_view left_;
  std::uint64_t offset_;
};

}  // namespace repel::record::detail
