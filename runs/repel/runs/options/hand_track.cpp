// SPDX-License-Identifier: BSD-3-Clause
#include <repel/runs/options/hand_track.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <sstream>
#include <string_view>
#include <utility>

#include <repel/base/setup_error.hpp>
#include <repel/common/input_limits.hpp>
#include <repel/common/text_file.hpp>

namespace repel::runs {
namespace {

constexpr std::string_view rates_line = "time_s,vx_m_s,vy_m_s,vz_m_s,wx_rad_s,wy_rad_s,wz_rad_s";
constexpr std::string_view lever_line = ",lever_rad_s,direction_x,direction_y,direction_z";

/// Ticks begin at a time that is rounded otherwise than a table.
constexpr double rounding = 1e-9;  // [s]

std::vector<double> numbers_of(std::string_view line) {
  std::vector<double> numbers;
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    double number = std::numeric_limits<double>::quiet_NaN();
    const char* const last = line.data() + end;
    if (std::from_chars(line.data() + begin, last, number).ptr != last) return {};
    numbers.push_back(number);
    begin = end + 1;
  }
  return numbers;
}

}  // namespace

HandRow hand_row_of(const std::vector<double>& x) noexcept {
  HandRow row{x[0], {{x[1], x[2], x[3]}, {x[4], x[5], x[6]}}};
  if (x.size() == 7) return row;
  row.lever_rate = x[7];
  row.direction_W = {x[8], x[9], x[10]};
  return row;
}

HandTrack::HandTrack(std::vector<HandRow> rows, const std::string& name) : rows_(std::move(rows)) {
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const HandRow& row = rows_[i];
    const int line = name.empty() ? 0 : static_cast<int>(i) + 2;
    const auto fail = [&](const char* what) {
      throw SetupError("row " + std::to_string(i + 1) + " of the hand " + what, name, line);
    };
    const bool is_finite = std::isfinite(row.time) && row.rates.linear.allFinite() &&
                           row.rates.angular.allFinite() && std::isfinite(row.lever_rate);
    if (!is_finite) fail("has what is no number; allowed: finite numbers");
    if (row.time < 0.0) fail("is before time 0; allowed: times from 0 on");
    if (i > 0 && !(row.time > rows_[i - 1].time)) {
      fail("is not later than the one before; allowed: times that grow");
    }
    if (!(std::abs(row.direction_W.norm() - 1.0) < 1e-6)) {
      fail("has a direction of the lever that is not of length one");
    }
  }
}

void HandTrack::read(double time, network::Command& command) const noexcept {
  command.hand.rest();
  const auto after = std::upper_bound(rows_.begin(), rows_.end(), time + rounding,
                                      [](double t, const HandRow& row) { return t < row.time; });
  if (after == rows_.begin()) return;
  const HandRow& row = *(after - 1);
  const double into = std::max(0.0, time - row.time);
  if (after == rows_.end() && into > rounding) return;
  command.hand.ball = row.rates;
  command.hand.lever_rate = row.lever_rate;
  command.hand.direction_W = row.direction_W;
  if (into <= rounding) return;
  const double share = into / (after->time - row.time);
  command.hand.ball.linear += share * (after->rates.linear - row.rates.linear);
  command.hand.ball.angular += share * (after->rates.angular - row.rates.angular);
}

HandTrack read_hand_track(const std::string& file) {
  std::istringstream text(text_of_file(file, "a table of a hand", input_limits.mesh_bytes));
  std::string line;
  std::getline(text, line);
  if (line.ends_with('\r')) line.pop_back();
  const bool has_lever = line == std::string(rates_line).append(lever_line);
  if (!has_lever && line != rates_line) {
    throw SetupError("the first line is not that of a hand; allowed: " + std::string(rates_line) +
                         ", and behind it possibly " + std::string(lever_line),
                     file, 1);
  }
  const std::size_t columns = has_lever ? 11 : 7;
  std::vector<HandRow> rows;
  for (int number = 2; std::getline(text, line); ++number) {
    if (line.ends_with('\r')) line.pop_back();
    const std::vector<double> numbers = numbers_of(line);
    if (numbers.size() != columns) {
      throw SetupError("a line of a hand without " + std::to_string(columns) +
                           " numbers; allowed: as many as names in the first line",
                       file, number);
    }
    rows.push_back(hand_row_of(numbers));
  }
  return HandTrack(std::move(rows), file);
}

}  // namespace repel::runs
