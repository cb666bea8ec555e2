// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Parses numbers with units.
#pragma once

#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace repel::scene {

/// A unit and its size in SI units, `times / over`: two numbers, so that 25 mm is exactly 0.025.
struct Unit {
  std::string_view name;
  double times = 1.0;
  double over = 1.0;
};

/// The units of a dimension; the first is the SI unit.
using Units = std::span<const Unit>;

namespace unit {
inline constexpr Unit none[] = {{""}};
inline constexpr Unit length[] = {{"m"}, {"cm", 1, 100}, {"mm", 1, 1000}};
inline constexpr Unit angle[] = {{"rad"}, {"deg", std::numbers::pi, 180}};
inline constexpr Unit time[] = {{"s"}, {"ms", 1, 1e3}, {"us", 1, 1e6}};
inline constexpr Unit frequency[] = {{"Hz"}, {"kHz", 1000}};
inline constexpr Unit speed[] = {{"m/s"}, {"cm/s", 1, 100}, {"mm/s", 1, 1000}};
inline constexpr Unit angular_speed[] = {{"rad/s"}, {"deg/s", std::numbers::pi, 180}};
inline constexpr Unit force[] = {{"N"}, {"kN", 1000}};
inline constexpr Unit torque[] = {{"N m"}, {"mN m", 1, 1000}};
inline constexpr Unit stiffness[] = {{"N/m"}, {"N/mm", 1000}, {"kN/m", 1000}};
inline constexpr Unit damping[] = {{"N s/m"}, {"kN s/m", 1000}};
inline constexpr Unit angular_stiffness[] = {{"N m/rad"}};
inline constexpr Unit angular_damping[] = {{"N m s/rad"}};
inline constexpr Unit mass[] = {{"kg"}, {"g", 1, 1000}};
inline constexpr Unit inertia[] = {{"kg m^2"}};
inline constexpr Unit energy[] = {{"J"}};
inline constexpr Unit share[] = {{""}, {"%", 1, 100}};
inline constexpr Unit length_per_angle[] = {{"m/rad"}, {"mm/rad", 1, 1000}};

/// All units of the dimension to which the unit `name` belongs.
///
/// @throws SetupError if there is no such unit
[[nodiscard]] Units of_dimension(std::string_view name);
}  // namespace unit

/// Unit and range of a value.
struct Rule {
  Units units;
  double low = 0.0;   ///< in the SI unit
  double high = 0.0;  ///< in the SI unit
  bool may_be_nan = false;
  bool may_be_auto = false;  ///< the word "auto" is allowed, and read as network::automatic
};

/// The numbers at the start of `text`, in SI units; none unless the rest is one of `units`.
/// Independent of the locale.
[[nodiscard]] std::optional<std::vector<double>> quantity(std::string_view text, Units units);

/// Whether `value` satisfies `rule`.
[[nodiscard]] bool obeys(double value, const Rule& rule);

/// "0 to 10 m"
[[nodiscard]] std::string range_text(const Rule& rule);

/// "m, cm or mm"
[[nodiscard]] std::string units_text(Units units);

}  // namespace repel::scene
