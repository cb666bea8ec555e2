// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/elements/signals.hpp>

#include <type_traits>

namespace repel::network {

bool HandInput::is_finite() const noexcept {
  bool all = true;
  for_each_field(
      [&all](const HandField& field, const auto& x) {
        using Number = std::remove_cvref_t<decltype(x)>;
        if constexpr (std::is_same_v<Number, double>) {
          all = all && (field.is_settled || x - x == 0.0);
        } else if constexpr (std::is_same_v<Number, Vec3>) {
          all = all && repel::is_finite(x);
        }
      },
      *this);
  return all;
}

const HandInput& Signals::of(Hand which) const noexcept {
  return which == Hand::first ? hand : second;
}

Vec<any_size> Signals::tool_flow() const noexcept {
  return dense::product<Vec<any_size>>(jacobian, rates);
}

Vec<any_size> Signals::mean_tool_flow() const noexcept {
  return dense::product<Vec<any_size>>(jacobian, mean_rates);
}

}  // namespace repel::network
