/// @file
/// The bytes of a file, or of memory, by their place.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <streambuf>
#include <string>

namespace repel::record::detail {

/// Reads at any place; nothing is read that lies behind the end the file had when it was opened.
class Source {
 public:
  /// @throws SetupError when `path` is not a file that can be read
  [[nodiscard]] static Source file(const std::string& path);
  /// `name` stands for the path in errors.
  [[nodiscard]] static Source memory(std::string bytes, std::string name);

  [[nodiscard]] const std::string& name() const noexcept { return name_; }
  [[nodiscard]] std::uint64_t size() const noexcept { return size_; }

  /// Fills `out` with the bytes from `offset` on; its size stays. The caller has compared both with
  /// size() before.
  /// @throws SetupError when the operating system does not give them
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
