// SPDX-License-Identifier: BSD-3-Clause
// A two-port without a function that propagates the state of the root to the leaf.
#include <repel/network/module.hpp>

using namespace repel::network;

struct OneWay {
  bool reflected(const Equivalent<any_size>& behind, Equivalent<any_size>& shown) noexcept {
    shown = behind;
    return true;
  }
};

Module module_of_its_own() {
  return OneWay();
}
