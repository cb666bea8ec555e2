// SPDX-License-Identifier: BSD-3-Clause
#include <repel/schedule/evaluation_plan.hpp>

#include <cstdint>

namespace repel::detail {

bool EvaluationLimit::is_set() const noexcept {
  return is_counted() || deadline != Clock::time_point::max();
}

bool EvaluationLimit::is_reached(std::int64_t spent) const noexcept {
  return spent >= work_units || (deadline != Clock::time_point::max() && Clock::now() >= deadline);
}

int EvaluationPlan::batches_of(int items) noexcept {
  return (items + batch_size - 1) / batch_size;
}

bool EvaluationPlan::is_single(int item) const noexcept {
  return singles_first_ ? item < singles_ : item >= groups_;
}

int EvaluationPlan::place_of(int item) const noexcept {
  return singles_first_ ? item : item - groups_;
}

int EvaluationPlan::single_of(int item) const noexcept {
  const int place = place_of(item);
  return in_order_.empty() ? place : in_order_[static_cast<std::size_t>(place)];
}

int EvaluationPlan::group_of(int item) const noexcept {
  const int g = first_group_ + (singles_first_ ? item - singles_ : item);
  return g < groups_ ? g : g - groups_;
}

}  // namespace repel::detail
