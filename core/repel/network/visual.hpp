/// @file
/// VISUAL: marks where a display looks, and changes nothing.
#pragma once

#include <repel/network/equivalent.hpp>
#include <repel/network/port.hpp>

namespace repel::network {

/// A tap: effort and flow pass as they are. What passes stands in the connections of the network
/// after every tick, where a display or a log takes it; the loop copies it to them through `Tap`
/// (loop/tap.hpp), so that none can hold up a tick.
class Visual {
 public:
  static constexpr Traits traits{.keeps_flow = true};

  [[nodiscard]] bool reflected(const Equivalent<any_size>& behind,
                               Equivalent<any_size>& shown) const noexcept {
    shown = behind;
    return true;
  }
  void incident(const PortState<any_size>& at_root, const Equivalent<any_size>& /*behind*/,
                PortState<any_size>& at_leaf) const noexcept {
    at_leaf = at_root;
  }
};

}  // namespace repel::network
