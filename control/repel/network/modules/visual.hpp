// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// VISUAL: a pass-through tap for displays and logs.
#pragma once

#include <repel/network/elements/equivalent.hpp>
#include <repel/network/elements/port.hpp>

namespace repel::network {

/// Effort and flow pass unchanged. They can be read from the connections of the network after every
/// tick; the loop copies them to displays and logs through `Tap` (loop/tap.hpp), so that no reader
/// can delay a tick.
class Visual {
 public:
  static constexpr Traits traits{.keeps_flow = true};  ///< any space on both sides

  /// What is behind, as it is. Always true.
  [[nodiscard]] bool reflected(const Equivalent<any_size>& behind,
                               Equivalent<any_size>& shown) const noexcept;
  /// The same state.
  void incident(const PortState<any_size>& at_root, const Equivalent<any_size>& /*behind*/,
                PortState<any_size>& at_leaf) const noexcept;
};

}  // namespace repel::network
