/// @file
/// JSON written straight into a string: a picture is made sixty times a second beside the ticks,
/// and what takes the processor's time or its cache there, slows them.
#pragma once

#include <charconv>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>

#include <repel/base/types.hpp>

namespace repel::visual {

/// Appends values with the commas between them. What is opened must be closed; names and text are
/// taken to need no escapes.
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
  /// A value that is JSON already.
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
  /// To a micrometre, a microradian, a micronewton: what nobody can see would make half of the
  /// text. null for what is not finite.
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
