// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/elements/junction.hpp>

namespace repel::network {

void Junction::begin(Equivalent<any_size>& branch, Equivalent<any_size>& sum) const noexcept {
  (void)branch.take_form(common_ == Common::flow ? Form::impedance : Form::admittance);
  sum = branch;
}

bool Junction::add(Equivalent<any_size>& branch, Equivalent<any_size>& sum) const noexcept {
  const bool by_flow = common_ == Common::flow;
  const Form summed = by_flow ? Form::impedance : Form::admittance;
  if (!branch.take_form(summed)) {
    if (!sum.take_form(summed)) return false;
    const Equivalent<any_size> others = sum;
    sum = branch;
    join(others, sum);
  } else {
    join(branch, sum);
  }
  return true;
}

void Junction::join(const Equivalent<any_size>& branch, Equivalent<any_size>& sum) const noexcept {
  if (common_ == Common::flow) {
    sum.add_impedance(branch.matrix, branch.offset);
  } else {
    sum.add_admittance(branch.matrix, branch.offset);
  }
}

}  // namespace repel::network
