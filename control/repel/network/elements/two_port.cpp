// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/elements/two_port.hpp>

namespace repel::network::series {

bool shown(const Equivalent<any_size>& behind, const Vec<any_size>& effort,
           Equivalent<any_size>& shown) noexcept {
  shown = behind;
  shown.add_effort(effort);
  return true;
}

void pass(const PortState<any_size>& at_root, const Vec<any_size>& effort,
          PortState<any_size>& at_leaf) noexcept {
  at_leaf.flow = at_root.flow;
  at_leaf.effort = at_root.effort - effort;
}

}  // namespace repel::network::series
