// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/modules/puma_kin.hpp>

#include <repel/network/elements/two_port.hpp>

namespace repel::network {

bool PumaKin::reflected(const Equivalent<any_size>& behind,
                        Equivalent<any_size>& shown) const noexcept {
  if (root_ == Side::left) return transformer::shown_at_a(behind, jacobian_, jacobian_, shown);
  if (behind.form != Form::impedance) {
    return transformer::shown_at_b(behind, jacobian_, jacobian_, shown);
  }
  shown.form = Form::impedance;
  if (behind.is_source()) {
    shown.matrix.setZero(jacobian_.cols(), jacobian_.cols());
  } else {
    dense::congruence(jacobian_, behind.matrix, shown.matrix);
  }
  dense::transposed_product(jacobian_, behind.offset, shown.offset);
  return true;
}

void PumaKin::incident(const PortState<any_size>& at_root, const Equivalent<any_size>& behind,
                       PortState<any_size>& at_leaf) const noexcept {
  if (root_ == Side::right) {
    transformer::to_a(at_root, behind, jacobian_, at_leaf);
  } else {
    transformer::to_b(at_root, behind, jacobian_, at_leaf);
  }
}

}  // namespace repel::network
