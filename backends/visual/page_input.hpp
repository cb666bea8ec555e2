// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The input of the driving page, from its messages.
#pragma once

#include <chrono>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include <repel/visual/arm_info.hpp>
#include <repel/visual/controls.hpp>

namespace repel::visual {

/// The reason for refusing a message with such a number.
inline constexpr const char* out_of_range = "a number is missing or out of range";

/// Each message has a part of it: the rates of one hand, or switches. The control loop reads the
/// newest input only, so each one repeats all before: switches stay, also from page to page, and
/// the rates of a hand last as long as PageCommand::rest_after.
class PageInput {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// @param arm the one that is driven
  explicit PageInput(const ArmInfo& arm) : arm_(arm) {}

  /// Whether messages of this type belong here.
  [[nodiscard]] static bool knows(const std::string& type);

  /// Empty; or the reason for refusing the message, without effect then.
  [[nodiscard]] std::string take(const std::string& type, const nlohmann::json& message, Time now);

  /// The hands are at rest, and those of another driver.
  void rest(Driver driver);

  /// Nothing was switched: a run begins.
  void forget();

  /// For the control loop.
  [[nodiscard]] DriverInput of(Time now) const;

 private:
  [[nodiscard]] std::string move(const nlohmann::json& message, Time now);
  [[nodiscard]] std::string lead_lever(const nlohmann::json& message, Time now);
  [[nodiscard]] std::string set_scale(const nlohmann::json& message);
  [[nodiscard]] std::string set_guides(const nlohmann::json& message);
  [[nodiscard]] std::string set_compliant(const nlohmann::json& message);

  ArmInfo arm_;
  DriverInput input_;
  Time first_said_, second_said_;  ///< when the rates of each hand were
};

}  // namespace repel::visual
