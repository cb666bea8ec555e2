// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The building block of two-ports that connect two spaces.
#pragma once

#include <repel/network/elements/equivalent.hpp>

namespace repel::network {

/// A lossless connection of two spaces: v_A = V v_B and f_B = F' f_A, with V = F unless a power
/// factor is declared. The same two matrices are used in both directions of a tick.
namespace transformer {

/// Equivalent of side A seen from B. False when it cannot take the impedance form.
template <class V, class F>
[[nodiscard]] bool shown_at_b(Equivalent<any_size> at_a, const V& flow_map, const F& effort_map,
                              Equivalent<any_size>& shown) noexcept {
  if (!at_a.take_form(Form::impedance)) return false;
  shown.form = Form::impedance;
  dense::sandwich(effort_map, at_a.matrix, flow_map, shown.matrix);
  dense::transposed_product(effort_map, at_a.offset, shown.offset);
  return true;
}

/// Equivalent of side B seen from A. False when it cannot take the admittance form.
template <class V, class F>
[[nodiscard]] bool shown_at_a(Equivalent<any_size> at_b, const V& flow_map, const F& effort_map,
                              Equivalent<any_size>& shown) noexcept {
  if (!at_b.take_form(Form::admittance)) return false;
  shown.form = Form::admittance;
  dense::sandwich(flow_map.transpose(), at_b.matrix, effort_map.transpose(), shown.matrix);
  dense::transposed_product(flow_map.transpose(), at_b.offset, shown.offset);
  return true;
}

/// State at A from that at B and the equivalent `at_a` of side A.
template <class V>
void to_a(const PortState<any_size>& at_b, const Equivalent<any_size>& at_a, const V& flow_map,
          PortState<any_size>& state) noexcept {
  const auto flow = dense::product<Vec<any_size>>(flow_map, at_b.flow);
  if (at_a.form == Form::impedance) return at_a.at_flow(flow, state);
  Equivalent<any_size> turned = at_a;
  (void)turned.take_form(Form::impedance);
  turned.at_flow(flow, state);
}

/// State at B from that at A and the equivalent `at_b` of side B.
template <class F>
void to_b(const PortState<any_size>& at_a, const Equivalent<any_size>& at_b, const F& effort_map,
          PortState<any_size>& state) noexcept {
  Vec<any_size> effort;
  dense::transposed_product(effort_map, at_a.effort, effort);
  if (at_b.form == Form::admittance) return at_b.at_effort(effort, state);
  Equivalent<any_size> turned = at_b;
  (void)turned.take_form(Form::admittance);
  turned.at_effort(effort, state);
}

}  // namespace transformer

}  // namespace repel::network
