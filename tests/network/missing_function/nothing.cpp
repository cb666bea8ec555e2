// SPDX-License-Identifier: BSD-3-Clause
// A type with none of the functions of a module.
#include <repel/network/module.hpp>

using namespace repel::network;

struct Nothing {};

Module module_of_its_own() {
  return Nothing();
}
