/// @file
/// Files that stand in their place only when they are whole.
#pragma once

#include <string>
#include <vector>

namespace repel::host {

/// A file that is written beside its place, in the same folder, and moved there when it is whole:
/// what stood there before is there until then. It is called PATH.part while it is written, or
/// PATH.2.part and so on where that is taken; a kill leaves it behind. A device, a pipe or what a
/// path leads to through /dev or /proc has no such place and is written directly. Links are
/// followed and stay.
class PartFile {
 public:
  /// Makes the file, empty. Nothing for an empty path.
  /// @throws SetupError where it, or what stands in its place, cannot be written
  explicit PartFile(const std::string& path);

  /// Removes it, unless it was put in its place or kept.
  ~PartFile();
  PartFile(const PartFile&) = delete;
  PartFile& operator=(const PartFile&) = delete;

  /// What is to be opened for writing.
  [[nodiscard]] const std::string& name() const { return part_; }
  /// False where it is written directly.
  [[nodiscard]] bool is_beside() const { return part_ != place_; }

  /// Moves it into its place, once it is written and closed.
  /// @throws SetupError where the disk or the folder does not take it; it is kept then
  void put_in_place();

  /// Leaves it where it is: not whole, but worth reading.
  void keep() { is_kept_ = true; }

 private:
  std::string place_;  ///< with its links resolved
  std::string part_;
  bool is_kept_ = false;
};

/// A file that a program is told to read or to write, and what it calls it.
struct NamedFile {
  std::string what;  ///< "the scene file", "--report"
  std::string path;  ///< empty: none
};

/// @throws SetupError where a file to write is one of those to read, or of those to write before
/// it, by whatever name or link. Devices and pipes may be written by several.
void require_apart(const std::vector<NamedFile>& read, const std::vector<NamedFile>& written);

}  // namespace repel::host
