// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/modules/multiplex.hpp>

#include <cmath>

#include <repel/base/setup_error.hpp>
#include <repel/network/elements/two_port.hpp>

namespace repel::network {

Multiplex::Multiplex(const MultiplexOptions& options) : options_(checked_fields(options)) {}

void Multiplex::prepare(double period) {
  const double time = options_.turning_time;
  share_ = time > 0.0 ? -std::expm1(-detail::checked_period(period) / time) : 1.0;
  scale_.prepare(period);
}

void Multiplex::read(const Signals& signals) noexcept {
  const HandInput& hand = signals.of(options_.hand);
  direction_ = begun_ ? direction_ + share_ * (hand.direction_W - direction_) : hand.direction_W;
  turning_ = begun_ ? turning_ + share_ * (hand.turning_W - turning_) : hand.turning_W;
  begun_ = true;
  scale_.step(hand.scale);
  for (int i = 0; i < 3; ++i) {
    flow_map_[i] = scale_.value() * options_.velocity_scale * direction_[i];
    effort_map_[i] = scale_.value() * options_.force_scale * direction_[i];
    flow_map_[3 + i] = scale_.value() * options_.velocity_scale * turning_[i];
    effort_map_[3 + i] = scale_.value() * options_.force_scale * turning_[i];
  }
}

bool Multiplex::reflected(const Equivalent<any_size>& behind,
                          Equivalent<any_size>& shown) const noexcept {
  if (root_ != Side::right) {
    return transformer::shown_at_b(behind, flow_map_, effort_map_, shown);
  }
  Equivalent<any_size> lever = behind;
  if (!lever.take_form(Form::admittance)) return false;
  shown.form = Form::admittance;
  shown.matrix.resize(6, 6);
  shown.offset.resize(6);
  const dense::Six flow(flow_map_.data());
  for (int k = 0; k < 6; ++k) {
    const double share = lever.matrix.coeff(0, 0) * effort_map_[k];
    flow.times(share).store(shown.matrix.col(k).data());
  }
  flow.times(lever.offset.coeff(0)).store(shown.offset.data());
  return true;
}

void Multiplex::incident(const PortState<any_size>& at_root, const Equivalent<any_size>& behind,
                         PortState<any_size>& at_leaf) const noexcept {
  if (root_ == Side::right) {
    transformer::to_b(at_root, behind, effort_map_, at_leaf);
  } else {
    transformer::to_a(at_root, behind, flow_map_, at_leaf);
  }
}

double Multiplex::power_factor() const noexcept {
  return options_.force_scale / options_.velocity_scale;
}

double Multiplex::velocity_scale() const noexcept {
  return options_.velocity_scale;
}

double Multiplex::flow_scale() const noexcept {
  return scale_.value() * options_.velocity_scale;
}

}  // namespace repel::network
