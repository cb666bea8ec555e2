// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Output files that replace their target only when they are complete.
#pragma once

#include <string>
#include <vector>

namespace repel::host {

/// A file that is written under a temporary name in the folder of its target and renamed to the
/// target when it is complete; an existing target stays until then. The temporary name is
/// PATH.part, or PATH.2.part and so on if that exists; it is left behind if the process is killed.
/// A device, a pipe, or a path through /dev or /proc is written directly. Symbolic links are
/// followed and kept.
class PartFile {
 public:
  /// Creates the file, empty. Does nothing for an empty path.
  /// @throws SetupError if it, or its target, cannot be written
  explicit PartFile(const std::string& path);

  /// Removes it, unless it was moved to its target or kept.
  ~PartFile();
  PartFile(const PartFile&) = delete;
  PartFile& operator=(const PartFile&) = delete;

  /// The name to open for writing.
  [[nodiscard]] const std::string& name() const { return part_; }
  /// False if the target is written directly.
  [[nodiscard]] bool is_beside() const { return part_ != place_; }

  /// Renames it to its target. Call once it is written and closed.
  /// @throws SetupError if it cannot be written to disk or renamed; it is kept then
  void put_in_place();

  /// Keeps the temporary file: incomplete, but worth reading.
  void keep() { is_kept_ = true; }

 private:
  std::string place_;  ///< with its links resolved
  std::string part_;
  bool is_kept_ = false;
};

/// A file that a program reads or writes, and its name in messages.
struct NamedFile {
  std::string what;  ///< "the scene file", "--report"
  std::string path;  ///< empty: none
};

/// @throws SetupError if a file to write is the same, by whatever name or link, as one to read or
///   an earlier one to write. Devices and pipes may be written by several.
void require_apart(const std::vector<NamedFile>& read, const std::vector<NamedFile>& written);

}  // namespace repel::host
