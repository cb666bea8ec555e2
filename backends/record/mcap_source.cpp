// SPDX-License-Identifier: BSD-3-Clause
#include "mcap_source.hpp"

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <ios>
#include <sstream>
#include <system_error>
#include <utility>

#include <repel/base/setup_error.hpp>

namespace repel::record::detail {

Source::Source(std::unique_ptr<std::streambuf> bytes, std::string name, std::uint64_t size)
    : bytes_(std::move(bytes)), name_(std::move(name)), size_(size) {}

Source Source::file(const std::string& path) {
  std::error_code error;
  // Directories and pipes can be opened too, but then read nothing or block.
  const bool regular = std::filesystem::is_regular_file(path, error);
  if (error) throw SetupError("cannot be read: " + error.message(), path);
  if (!regular) throw SetupError("is no regular file; allowed: an MCAP file", path);
  const std::uint64_t size = std::filesystem::file_size(path, error);
  if (error) throw SetupError("cannot be read: " + error.message(), path);
  auto bytes = std::make_unique<std::filebuf>();
  errno = 0;
  if (bytes->open(path, std::ios::in | std::ios::binary) == nullptr) {
    throw SetupError("cannot be opened: " + std::generic_category().message(errno), path);
  }
  return {std::move(bytes), path, size};
}

Source Source::memory(std::string bytes, std::string name) {
  const std::uint64_t size = bytes.size();
  return {std::make_unique<std::stringbuf>(std::move(bytes), std::ios::in), std::move(name), size};
}

void Source::read(std::uint64_t offset, std::string& out) {
  std::streamsize count = -1;
  try {
    // A seek discards the buffer, so it is avoided for consecutive records.
    const bool there = at_ == offset || bytes_->pubseekpos(static_cast<std::streamoff>(offset),
                                                           std::ios::in) != std::streamoff{-1};
    if (there) count = bytes_->sgetn(out.data(), static_cast<std::streamsize>(out.size()));
  } catch (const std::ios_base::failure&) {
    count = -1;
  }
  at_ = offset + out.size();
  if (count == static_cast<std::streamsize>(out.size())) return;
  at_ = size_ + 1;  // unknown: the next read seeks
  fail(offset, std::to_string(out.size()) + " bytes cannot be read");
}

void Source::fail(std::uint64_t offset, const std::string& what) const {
  std::string text = "at byte " + std::to_string(offset);
  text += ": ";
  text += what;
  throw SetupError(text, name_);
}

}  // namespace repel::record::detail
