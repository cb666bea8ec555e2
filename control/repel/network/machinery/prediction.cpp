// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/machinery/prediction.hpp>

#include <repel/network/elements/two_port.hpp>

namespace repel::network {

void Prediction::fit(Space space, int size) {
  in_joints_ = space == Space::joints;
  offset_.setZero(size);
  sum_.setZero(size);
}

void Prediction::predict(const Signals& signals, const Vec<any_size>& walls,
                         const Mat<any_size>& damping) noexcept {
  const Eigen::Index n = signals.inertia.rows();
  is_known_ = n > 0 && n == walls.size();
  if (!is_known_) return;
  observe(signals);
  walls_ = walls;
  has_damping_ = false;
  for (Eigen::Index i = 0; i < n; ++i) has_damping_ = has_damping_ || damping.coeff(i, i) > 0.0;
  if (has_damping_) damping_ = damping;
  const double rate = 1.0 / horizon_;
  is_known_ = held_.factor(n, [&](Eigen::Index i) {  // M / h + C
    return rate * signals.inertia.data()[i] + damping.data()[i];
  });
  if (is_known_) move_to_port(signals);
}

bool Prediction::reflected(const Equivalent<any_size>& behind,
                           Equivalent<any_size>& shown) const noexcept {
  shown = behind;
  if (!is_known_) return true;
  const bool is_impedance = shown.form == Form::impedance;
  if (is_impedance && (in_joints_ || !shown.take_form(Form::admittance))) {
    shown.add_admittance(conductance_, -(flow_ + offset_));
    shown.matrix.setZero();
    return true;
  }
  const Eigen::Index n = conductance_.rows();
  const double *own = conductance_.data(), *added = shown.matrix.data();
  dense::Factored both;
  if (!both.factor(n, [=](Eigen::Index i) { return own[i] + added[i]; })) return false;
  shown.form = Form::impedance;
  shown.matrix.setZero(n, n);
  shown.offset = flow_ + offset_ - shown.offset;
  both.solve(shown.offset);
  return true;
}

void Prediction::incident(const PortState<any_size>& at_root,
                          const Equivalent<any_size>& /*behind*/,
                          PortState<any_size>& at_leaf) noexcept {
  at_leaf = at_root;
  if (!is_known_) return;
  const Vec<any_size> on_arm = -at_root.effort;
  Vec<any_size> change = offset_;
  dense::add_product(conductance_, on_arm, change);
  for (Eigen::Index i = 0; i < change.size(); ++i) {
    sum_.coeffRef(i) += period_ * change.coeff(i);
    at_leaf.flow.coeffRef(i) += change.coeff(i);
  }
  if (in_joints_) {
    sent_ = on_arm;
  } else {
    dense::transposed_product(jacobian_, on_arm, sent_);
  }
  sent_ += walls_;
  if (has_damping_) sent_ -= given_up(foreseen(sent_));
}

Vec<any_size> Prediction::foreseen(const Vec<any_size>& total) const noexcept {
  if (!is_known_) return Vec<any_size>::Zero(total.size());
  Vec<any_size> change = total;
  held_.solve(change);
  return change;
}

Vec<any_size> Prediction::given_up(const Vec<any_size>& change) const noexcept {
  if (!is_known_ || !has_damping_) return Vec<any_size>::Zero(change.size());
  return dense::product<Vec<any_size>>(damping_, change);
}

void Prediction::observe(const Signals& signals) noexcept {
  if (sent_.size() != signals.rates.size() || signals.at_rest) {
    others_.setZero(signals.rates.size());
  } else {
    const Vec<any_size> change = signals.rates - last_rates_;
    const Vec<any_size> momentum = dense::product<Vec<any_size>>(signals.inertia, change);
    const double inverse = 1.0 / signals.since_last();
    for (Eigen::Index i = 0; i < others_.size(); ++i) {
      const double seen = inverse * momentum.coeff(i) - sent_.coeff(i);
      others_.coeffRef(i) += adaptation(delay_) * (seen - others_.coeff(i));
    }
  }
  last_rates_ = signals.rates;
}

void Prediction::move_to_port(const Signals& signals) noexcept {
  flow_ = in_joints_ ? signals.rates : signals.tool_flow();
  offset_ = walls_ + others_;
  if (in_joints_) {
    held_.solve(offset_);
    invert();
  } else {
    jacobian_ = signals.jacobian;
    through_jacobian();
  }
  if (signals.at_rest) sum_ = horizon_ * flow_;
  period_ = signals.period;
  const double share = leak(delay_) / period_;
  for (Eigen::Index i = 0; i < offset_.size(); ++i) {
    offset_.coeffRef(i) += share * (horizon_ * flow_.coeff(i) - sum_.coeff(i));
  }
}

void Prediction::invert() noexcept {
  const Eigen::Index n = held_.size();
  conductance_.resize(n, n);
  for (Eigen::Index k = 0; k < n; ++k) {
    Vec<any_size> column = Vec<any_size>::Zero(n);
    column.coeffRef(k) = 1.0;
    held_.solve(column);
    for (Eigen::Index i = 0; i < n; ++i) conductance_.coeffRef(i, k) = column.coeff(i);
  }
}

void Prediction::through_jacobian() noexcept {
  using dense::Six;
  constexpr std::ptrdiff_t six = 6;
  const int n = held_.size();
  held_.descend(offset_);
  double W[6 * most_joints];
  Six flow, columns[6];
  for (int k = 0; k < n; ++k) {
    Six row(jacobian_.data() + six * k);
    for (int j = 0; j < k; ++j) row.add(-held_.lower(k, j), Six(W + six * j));
    row.store(W + six * k);
    const Six scaled = row.times(held_.inverse(k));
    for (int j = 0; j < 6; ++j) columns[j].add(W[6 * k + j], scaled);
    flow.add(offset_.coeff(k), scaled);
  }
  conductance_.resize(6, 6);
  for (int j = 0; j < 6; ++j) columns[j].store(conductance_.data() + six * j);
  offset_.resize(6);
  flow.store(offset_.data());
}

}  // namespace repel::network
