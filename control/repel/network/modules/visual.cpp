// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/modules/visual.hpp>

namespace repel::network {

bool Visual::reflected(const Equivalent<any_size>& behind,
                       Equivalent<any_size>& shown) const noexcept {
  shown = behind;
  return true;
}

void Visual::incident(const PortState<any_size>& at_root, const Equivalent<any_size>& /*behind*/,
                      PortState<any_size>& at_leaf) const noexcept {
  at_leaf = at_root;
}

}  // namespace repel::network
