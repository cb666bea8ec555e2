// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/machinery/ledger.hpp>

#include <algorithm>

namespace repel::network {

void Ledger::add(double in, double moved, double from_source) noexcept {
  supplied += from_source;
  energy += in + from_source;
  least = std::min(least, energy);
  passed += moved;
}

double Ledger::deficit() const noexcept {
  return std::max(0.0, -least) / std::max(passed, 1e-3);
}

}  // namespace repel::network
