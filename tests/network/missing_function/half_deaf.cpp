// SPDX-License-Identifier: BSD-3-Clause
// A one-port whose function for the state of its port takes something else.
#include <repel/network/module.hpp>

using namespace repel::network;

struct HalfDeaf {
  void equivalent(Equivalent<any_size>&) const noexcept {}
  void incident(double) noexcept {}
};

Module module_of_its_own() {
  return HalfDeaf();
}
