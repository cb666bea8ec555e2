// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/elements/changing_scale.hpp>

namespace repel::network {

void ChangingScale::step(double wanted) noexcept {
  if (!(wanted >= least && wanted <= most)) return;
  value_ = begun_ ? value_ + share_ * (wanted - value_) : wanted;
  begun_ = true;
}

}  // namespace repel::network
