// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The only exception of the library. Thrown at set-up only, never by the tick.
#pragma once

#include <charconv>
#include <cmath>
#include <stdexcept>
#include <string>
#include <string_view>

namespace repel {

/// An error in an input: the fault, its place, the value found and the range allowed.
class SetupError : public std::runtime_error {
 public:
  /// @param what_is_wrong one sentence, without the location
  /// @param file the file with the error; empty for a value given in code
  /// @param line its line number, from 1; 0 for none
  explicit SetupError(const std::string& what_is_wrong, std::string file = {}, int line = 0)
      : std::runtime_error(place(file, line) + what_is_wrong),
        file_(std::move(file)),
        line_(line) {}

  /// The file that was read; empty without one.
  [[nodiscard]] const std::string& file() const noexcept { return file_; }
  /// The line in it, from 1; 0 without one.
  [[nodiscard]] int line() const noexcept { return line_; }

 private:
  static std::string place(const std::string& file, int line) {
    if (file.empty()) return {};
    return line > 0 ? file + ":" + std::to_string(line) + ": " : file + ": ";
  }

  std::string file_;
  int line_ = 0;
};

/// `value` in the shortest form that reads back exactly, independent of the locale.
[[nodiscard]] inline std::string to_text(double value) {
  char digits[32];
  const auto end = std::to_chars(digits, digits + sizeof digits, value).ptr;
  return {digits, end};
}

/// `value` rounded to `digits` significant digits, for display.
[[nodiscard]] inline std::string to_text(double value, int digits) {
  char text[32];
  const auto end =
      std::to_chars(text, text + sizeof text, value, std::chars_format::scientific, digits - 1).ptr;
  double rounded = value;
  std::from_chars(text, end, rounded);
  return to_text(rounded);
}

/// `value` rounded up to `digits` significant digits, for advice on a sufficient value. A part of
/// 1e-12 of it is rounding.
[[nodiscard]] inline std::string to_text_above(double value, int digits) {
  if (!(value > 0.0)) return to_text(value, digits);
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - digits + 1);
  return to_text(unit * std::ceil(value / unit * (1.0 - 1e-12)), digits);
}
/// The same, rounded down.
[[nodiscard]] inline std::string to_text_below(double value, int digits) {
  if (!(value > 0.0)) return to_text(value, digits);
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - digits + 1);
  return to_text(unit * std::floor(value / unit * (1.0 + 1e-12)), digits);
}

/// Returns `value` when `low <= value <= high`; throws SetupError naming it, its unit and the
/// range.
inline double checked(std::string_view name, double value, double low, double high,
                      std::string_view unit) {
  if (value >= low && value <= high) return value;  // NaN fails both
  std::string after(unit);
  if (!after.empty()) after.insert(0, 1, ' ');
  std::string text(name);
  text += " is " + to_text(value) + after + "; allowed: " + to_text(low) + " to " + to_text(high) +
          after;
  throw SetupError(text);
}

}  // namespace repel
