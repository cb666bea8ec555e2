// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Writes JSON directly into a string. A picture is made sixty times a second in parallel with the
/// ticks, and its use of processor time and cache would slow them down.
#pragma once

#include <charconv>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>

#include <repel/base/types.hpp>

namespace repel::visual {

/// Appends values and the commas between them. Every open() needs a close(); names and text must
/// not need escapes.
class JsonText {
 public:
  JsonText& open(char bracket) {
    separate();
    text_ += bracket;
    first_ = true;
    return *this;
  }
  JsonText& close(char bracket) {
    text_ += bracket;
    first_ = false;
    return *this;
  }
  JsonText& name(std::string_view name) {
    separate();
    text_ += '"';
    text_ += name;
    text_ += "\":";
    first_ = true;
    return *this;
  }
  /// A value that is already JSON.
  JsonText& json(std::string_view value) {
    separate();
    text_ += value;
    return *this;
  }
  JsonText& boolean(bool value) { return json(value ? "true" : "false"); }
  JsonText& integer(std::int64_t value) {
    char digits[24];
    return json({digits, std::to_chars(digits, digits + sizeof digits, value).ptr});
  }
  /// Rounded to 1e-6 (micrometre, microradian, micronewton): invisible digits would be half of the
  /// text. null if not finite.
  JsonText& number(double value) {
    if (!std::isfinite(value)) return json("null");
    const double shown = std::round(1e6 * value) / 1e6;
    char digits[32];
    return json({digits, std::to_chars(digits, digits + sizeof digits, shown).ptr});
  }
  JsonText& vector(const Vec3& v) {
    return open('[').number(v.x()).number(v.y()).number(v.z()).close(']');
  }
  JsonText& pose(const Pose& X) {
    const Vec3 p = X.translation();
    const Eigen::Quaterniond q(X.linear());
    open('[').number(p.x()).number(p.y()).number(p.z());
    return number(q.x()).number(q.y()).number(q.z()).number(q.w()).close(']');
  }

  [[nodiscard]] std::string&& take() && { return std::move(text_); }

 private:
  void separate() {
    if (!first_) text_ += ',';
    first_ = false;
  }

  std::string text_;
  bool first_ = true;
};

}  // namespace repel::visual
