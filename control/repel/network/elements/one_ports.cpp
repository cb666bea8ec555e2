// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/elements/one_ports.hpp>

namespace repel::network {

void Ground::equivalent(Equivalent<any_size>& shown) const noexcept {
  shown.form = Form::admittance;
  shown.matrix.setZero(size_, size_);
  shown.offset.setZero(size_);
}

}  // namespace repel::network
