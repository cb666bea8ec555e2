// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Compression of chunks by zstd (RFC 8878), if it was built in.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

namespace repel::record::detail {

/// The name of the compression in MCAP files.
inline constexpr std::string_view zstd_name = "zstd";

/// How to have it, for errors: empty if it was built in.
[[nodiscard]] std::string_view how_to_have_zstd() noexcept;

/// [bytes] No more can be in `packed` bytes of zstd: a block of 128 KiB takes four bytes at least.
[[nodiscard]] constexpr std::uint64_t most_unpacked(std::uint64_t packed) noexcept {
  return (packed / 4 + 1) * 131072;
}

/// Compresses chunks, one after the other. Its memory is kept for the next.
class Packer {
 public:
  Packer();
  ~Packer();
  Packer(const Packer&) = delete;
  Packer& operator=(const Packer&) = delete;

  /// Replaces `out`. False, without a change of `out`, if it was not built in or fails, as for want
  /// of memory. Cost: a few nanoseconds per byte.
  [[nodiscard]] bool pack(std::string_view bytes, std::string& out);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Decompresses chunks, one after the other.
class Unpacker {
 public:
  Unpacker();
  ~Unpacker();
  Unpacker(const Unpacker&) = delete;
  Unpacker& operator=(const Unpacker&) = delete;

  /// What became of a chunk: it is as long as was said, it ends early, or it is none or longer.
  enum class Outcome : std::uint8_t { whole, cut, damaged };

  /// Replaces `out` by the content of `packed` up to its end or damage, at most `size` bytes.
  /// Allocates at most about twice what has really been decompressed, and 16 MiB.
  [[nodiscard]] Outcome unpack(std::string_view packed, std::uint64_t size, std::string& out);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace repel::record::detail
