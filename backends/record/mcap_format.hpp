// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Shared by writer and reader of MCAP files: record types, limits, and serialisation. The format:
/// https://mcap.dev/spec
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>

namespace repel::record::detail {

using namespace std::string_view_literals;

/// The first and last bytes of a file.
inline constexpr std::string_view magic = "\x89MCAP0\r\n"sv;

/// Record type, the first byte of a record; eight bytes with the length of its content follow.
enum class Op : std::uint8_t {
  header = 0x01,
  footer = 0x02,
  schema = 0x03,
  channel = 0x04,
  message = 0x05,
  chunk = 0x06,
  message_index = 0x07,
  chunk_index = 0x08,
  attachment = 0x09,
  attachment_index = 0x0a,
  statistics = 0x0b,
  metadata = 0x0c,
  metadata_index = 0x0d,
  summary_offset = 0x0e,
  data_end = 0x0f,
};

inline constexpr std::size_t prefix_bytes = 9;  ///< record type and length
inline constexpr std::size_t footer_bytes = 20;

/// Position of a record in a file.
struct Record {
  Op op{};
  std::uint64_t offset = 0;  // of its first byte
  std::uint64_t length = 0;  // of its content

  [[nodiscard]] std::uint64_t content() const { return offset + prefix_bytes; }
  [[nodiscard]] std::uint64_t end() const { return content() + length; }
};

inline constexpr std::uint64_t mebibyte = 1U << 20;
/// Maximum content of any record that the reader accepts.
inline constexpr std::uint64_t largest_record = 256 * mebibyte;
/// Maximum total of schemas, channels, attachments and metadata that the reader keeps in memory.
inline constexpr std::uint64_t largest_kept = 1024 * mebibyte;
// The writer's limits ensure that no chunk exceeds the reader's limit.
inline constexpr std::uint64_t largest_message = 64 * mebibyte;
inline constexpr std::uint64_t largest_chunk_limit = 64 * mebibyte;
inline constexpr std::uint64_t largest_description = 16 * mebibyte;  ///< schema, channel, metadata
inline constexpr std::uint64_t largest_attachment = 255 * mebibyte;

/// Appends `value` in little-endian order.
template <std::unsigned_integral T>
void put(std::string& out, T value) {
  for (std::size_t i = 0; i < sizeof(T); ++i) {
    out.push_back(static_cast<char>((std::uint64_t{value} >> (8 * i)) & 0xff));
  }
}

/// Appends `text` with a length prefix of four bytes.
inline void put_text(std::string& out, std::string_view text) {
  put(out, static_cast<std::uint32_t>(text.size()));
  out += text;
}

/// Appends the pairs of `map` with a length prefix of four bytes, in bytes.
inline void put_map(std::string& out, const std::map<std::string, std::string>& map) {
  std::string pairs;
  for (const auto& [key, value] : map) {
    put_text(pairs, key);
    put_text(pairs, value);
  }
  put_text(out, pairs);
}

/// Appends a record with this content.
inline void put_record(std::string& out, Op op, std::string_view content) {
  out.push_back(static_cast<char>(op));
  put(out, std::uint64_t{content.size()});
  out += content;
}

}  // namespace repel::record::detail
