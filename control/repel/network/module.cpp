// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/module.hpp>

namespace repel::network {

Module& Module::operator=(const Module& other) {
  if (this != &other) *this = Module(other);
  return *this;
}

}  // namespace repel::network
