// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Runs work on untrusted files in a child process: libraries may crash on them or never end.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>

namespace repel::detail {

/// Resource limits of the child.
struct ChildLimits {
  int seconds = 1;                              ///< [s] of processor time
  std::size_t memory = std::size_t{256} << 20;  ///< [byte] in addition to that of this process
};

/// Runs `work` in a forked copy of this process and returns its result, so that a crash or an
/// endless loop does no harm. Set-up only: it forks.
/// @throws SetupError that `work` throws, with the message of any other exception, or saying how
///   the child ended
[[nodiscard]] std::string result_of_child(const std::function<std::string()>& work,
                                          const ChildLimits& limits);

/// The same for work on one file, of up to input_limits.mesh_bytes. The limits grow with its size,
/// up to those of input_limits for meshes.
/// @param what the file is, for errors: "mesh"
/// @param expansion [byte] of memory for each byte of the file
/// @throws SetupError beginning with `what` and the path; also if it is a directory, a device or a
///   pipe
[[nodiscard]] std::string result_of_file(const std::filesystem::path& path, const std::string& what,
                                         std::size_t expansion,
                                         const std::function<std::string()>& work);

}  // namespace repel::detail
