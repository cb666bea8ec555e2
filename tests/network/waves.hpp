// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// From waves back to effort and flow, for tests of wave ports.
#pragma once

#include <Eigen/Cholesky>

#include <repel/network/elements/port.hpp>

namespace repel::test {

/// Effort and flow of the port with waves `a` and `b` and resistance `R`.
template <int N>
[[nodiscard]] network::PortState<N> state_of(const network::Vec<N>& a, const network::Vec<N>& b,
                                             const network::Mat<N>& R) {
  const Eigen::LLT<network::Mat<N>> factor(R);
  const network::Vec<N> half = 0.5 * (a - b);
  return {0.5 * (a + b), factor.solve(half)};
}

}  // namespace repel::test
