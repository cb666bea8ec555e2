// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Random access to the bytes of a file or of memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <streambuf>
#include <string>

namespace repel::record::detail {

/// Never reads beyond the size that the file had when it was opened.
class Source {
 public:
  /// @throws SetupError if `path` is no readable file
  [[nodiscard]] static Source file(const std::string& path);
  /// `name` replaces the path in errors.
  [[nodiscard]] static Source memory(std::string bytes, std::string name);

  [[nodiscard]] const std::string& name() const noexcept { return name_; }
  [[nodiscard]] std::uint64_t size() const noexcept { return size_; }

  /// Fills `out`, without resizing it, with the bytes from `offset` on. The caller must check both
  /// against size().
  /// @throws SetupError on a read error
  void read(std::uint64_t offset, std::string& out);

  /// "at byte OFFSET: WHAT" as an error of this file.
  /// @throws SetupError always
  [[noreturn]] void fail(std::uint64_t offset, const std::string& what) const;

 private:
  Source(std::unique_ptr<std::streambuf> bytes, std::string name, std::uint64_t size);

  std::unique_ptr<std::streambuf> bytes_;
  std::string name_;
  std::uint64_t size_;
  std::uint64_t at_ = 0;
};

}  // namespace repel::record::detail
