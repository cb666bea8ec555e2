// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The key that both sides of a sealed link share, and its file.
#pragma once

#include <array>
#include <cstdint>
#include <string>

namespace repel::sealed {

/// 256 random bits. Who has them can drive the robot.
using Key = std::array<std::uint8_t, 32>;

/// Writes a new key to a file that does not exist: 64 hexadecimal digits and a line feed, for its
/// owner alone (mode 0600).
/// @throws SetupError if the file exists or cannot be written
void make_key(const std::string& file);

/// Reads the key of a file. @throws SetupError for a file that is missing, no regular file, open to
/// others than its owner, or no key
[[nodiscard]] Key load_key(const std::string& file);

}  // namespace repel::sealed
