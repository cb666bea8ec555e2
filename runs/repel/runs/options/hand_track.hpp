// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What the hand of an operator does, as a table by time.
#pragma once

#include <string>
#include <vector>

#include <repel/network/operator.hpp>

namespace repel::runs {

/// A row of the table.
struct HandRow {
  double time = 0.0;          ///< [s] since the run began
  Twist rates;                ///< [m/s, rad/s] of the hand, world axes
  double lever_rate = 0.0;    ///< [rad/s] of the hand at the lever
  Vec3 direction_W{1, 0, 0};  ///< in which the lever drives the tool; unit
};

/// The row of 7 numbers, time and rates, or of 11, with the lever.
[[nodiscard]] HandRow hand_row_of(const std::vector<double>& numbers) noexcept;

/// The rates of a hand, linear between the rows; the lever is that of the row before. The hand
/// rests before the first row and after the last.
class HandTrack {
 public:
  /// @param name of it in errors, a file @throws SetupError for a number that is not finite, a time
  /// that is not above that of the row before, and a direction that is not of length one
  explicit HandTrack(std::vector<HandRow> rows, const std::string& name = {});

  /// Writes to the command what the hand does at `time` [s]. Logarithmic in the number of rows.
  void read(double time, network::Command& command) const noexcept;

 private:
  std::vector<HandRow> rows_;
};

/// Reads a table: a first line `time_s,vx_m_s,vy_m_s,vz_m_s,wx_rad_s,wy_rad_s,wz_rad_s`, behind it
/// possibly `,lever_rad_s,direction_x,direction_y,direction_z`, then a line of numbers for each
/// row.
/// @throws SetupError naming file and line
[[nodiscard]] HandTrack read_hand_track(const std::string& file);

}  // namespace repel::runs
