// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Reads a whole file into memory, up to a size limit.
#pragma once

#include <cstddef>
#include <fstream>
#include <string>

#include <repel/base/setup_error.hpp>
#include <repel/common/input_limits.hpp>

namespace repel {

/// The bytes of the file at `path`. At most `most` + 1 [byte] are read, so that an endless device
/// or pipe is refused too.
/// @param what the expected kind of file, for errors: "a scene file"
/// @throws SetupError naming the file when it cannot be read or is larger than `most`
[[nodiscard]] inline std::string text_of_file(const std::string& path, const std::string& what,
                                              std::size_t most = input_limits.file_bytes) {
  if (path.empty()) throw SetupError("the name of the file is empty; allowed: " + what);
  // <filesystem> costs a tenth of the compile time of the kernel.
  if (std::ifstream(path + "/.")) {
    throw SetupError("this is a directory; allowed: " + what, path);
  }
  std::ifstream file(path, std::ios::binary);
  if (!file) throw SetupError("the file cannot be opened; allowed: " + what, path);
  std::string text;
  constexpr std::size_t block = std::size_t{1} << 16;
  while (file && text.size() <= most) {
    const std::size_t before = text.size();
    const std::size_t wanted = most - before < block ? most - before + 1 : block;
    text.resize(before + wanted);
    file.read(text.data() + before, static_cast<std::streamsize>(wanted));
    text.resize(before + static_cast<std::size_t>(file.gcount()));
  }
  if (file.bad()) throw SetupError("the file cannot be read; allowed: " + what, path);
  if (text.size() > most) {
    const auto end = static_cast<std::streamoff>(file.seekg(0, std::ios::end).tellg());
    const auto size = static_cast<std::size_t>(end);
    const bool known = end > 0 && size > most;
    throw SetupError((known ? "the file has " + std::to_string(size) + " bytes"
                            : "the file has more than " + std::to_string(most) + " bytes") +
                         "; allowed: " + what + " of up to " + std::to_string(most),
                     path);
  }
  return text;
}

}  // namespace repel
