// SPDX-License-Identifier: BSD-3-Clause
#include <repel/loop/barrier/entry_barrier.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

#include <repel/base/setup_error.hpp>
#include <repel/loop/barrier/speed_bounds.hpp>
#include <repel/network/machinery/prediction.hpp>

namespace repel {
namespace {

constexpr double least_miss = 1e-4;  // [m/s] of a rate that counts as missed

}  // namespace

EntryBarrier::EntryBarrier(const ArmModel& model, double period, double drive_delay,
                           double slew_time, std::size_t pairs, const EntryBarrierOptions& options)
    : options_(options),
      period_(period),
      delay_(drive_delay),
      slew_time_(slew_time),
      step_(std::max(period, slew_time)),
      reaction_(network::Prediction::horizon(drive_delay) * period + 2.0 * step_),
      rows_(model, margin()),
      forecast_(model, period, drive_delay, step_),
      stops_(BarrierRows::most),
      withstood_(pairs, 0.0) {
  checked("margin", options.margin, 0.0, 0.1, "m");
  checked("mass uncertainty", options.mass_uncertainty, 1.0, 10.0, "");
  checked("recovery", options.recovery, 0.0, 10.0, "m/s");
  for (std::size_t i = 0; i < model.links.size(); ++i) effort_.push_back(effort_bound(model, i));
}

void EntryBarrier::watch(const Contacts& contacts, BodyId tool, const Jacobian& jacobian,
                         const ArmBodies& links, std::span<const double> q,
                         std::span<const double> v, std::span<const double> untold) noexcept {
  if (!is_on()) return;
  rows_.gather(contacts.hard, tool, jacobian, links, q, v, untold, reaction_);
  left_out_ = contacts.left_out + rows_.left_out();
}

Status EntryBarrier::forget() noexcept {
  const auto comes = [this](const BarrierRow& row) {
    const double soon = row.gap + margin() + (delay_ * period_ + 2.0 * reaction_) * row.rate;
    return row.pair.valid() && row.rate < -least_speed && soon < 0.0;
  };
  const bool is_lost = std::any_of(rows_.all().begin(), rows_.all().end(), comes);
  rows_.clear();
  forecast_.forget();
  if (is_lost) ++totals_.lost;
  return is_lost ? status::hold_lost : 0U;
}

bool EntryBarrier::observe(std::span<const double> v, const ArmInertia& inertia) noexcept {
  force_ = 0.0;
  pushed_ = {};
  proof_ = {};
  if (!is_on()) return false;
  forecast_.observe(v, inertia);
  if (!rows_.all().empty()) return true;
  forecast_.forget();
  return false;
}

void EntryBarrier::bound(LeastConstraint& problem, std::span<const double> weight,
                         std::span<const double> v, const ArmInertia& inertia) noexcept {
  forecast_.predict(v, inertia, problem.mass());
  for (std::size_t k = 0; k < rows_.all().size(); ++k) {
    add(problem, rows_.all()[k], stops_[k], weight);
  }
}

Status EntryBarrier::account(LeastConstraint& problem, std::span<const double> lower,
                             std::span<const double> upper,
                             std::span<const double> efforts) noexcept {
  count(problem, efforts);
  proof_.missed = std::max(0.0, problem.missed());
  if (proof_.missed > least_miss) {
    // Rows that no torques can keep together are braked by what is left for each.
    std::array<double, network::dense::most_rows> least{};
    for (std::size_t i = 0; i < efforts.size(); ++i) least[i] = -efforts[i];
    (void)problem.solve(std::span(least).first(efforts.size()), efforts);
    for (std::size_t k = 0; k < held(problem); ++k) {
      const LeastConstraint::Row& bound = problem.rows()[k];
      const double after = problem.rate_after(bound);
      if (bound.least_rate - after <= least_miss) continue;
      stops_[k].at_most = std::min(stops_[k].at_most, (after - bound.rate) / step_);
    }
    (void)problem.solve(lower, upper);
  }
  return judge(problem);
}

double EntryBarrier::withstood(PairId pair) const noexcept {
  return is_on() ? withstood_[static_cast<std::size_t>(pair.index)] : 0.0;
}

double EntryBarrier::margin() const noexcept {
  return options_.margin * std::max(1.0, 400.0 * period_);
}

void EntryBarrier::add(LeastConstraint& problem, const BarrierRow& row, Stopping& stop,
                       std::span<const double> weight) noexcept {
  const double late = delay_ * period_;  // [s] what cannot be changed any more
  const double bending = std::min(0.0, row.bending);
  const double gained = forecast_.least_gain(row.h) + (late + step_) * bending;
  LeastConstraint::Row* bound = problem.add(row.h, row.rate + gained);
  if (bound == nullptr) return;
  stop = stopping(*bound, weight);
  stop.surely = std::max(stop.surely + bending, 0.1 * stop.surely);
  stop.at_most += bending;
  if (row.top_speed > 0.0) {
    bound->least_rate = -row.top_speed;
    return;
  }
  double gap = row.gap + late * std::min({row.rate, bound->rate, 0.0});
  if (row.is_shared) {
    // Each arm gets half of the gap, plus what the other one overshoots.
    gap = gap > 0.0 ? 0.5 * gap : gap;
    bound->rate += std::min(0.0, row.others + allowed(gap, stop.surely)) - row.others;
  }
  bound->least_rate = -allowed(gap + 0.5 * step_ * bound->rate, stop.surely);
}

EntryBarrier::Stopping EntryBarrier::stopping(const LeastConstraint::Row& row,
                                              std::span<const double> weight) const noexcept {
  double force = std::numeric_limits<double>::infinity();  // [N] that the joints can give
  Stopping stop;
  for (std::size_t i = 0; i < weight.size(); ++i) {
    const double h = row.h.coeff(index(i));
    const double u = row.moved.coeff(index(i));
    stop.at_most += std::abs(u) * std::max(0.0, effort_[i] - (u > 0.0 ? weight[i] : -weight[i]));
    if (std::abs(h) < 1e-9) continue;
    const double room = std::max(0.0, h > 0.0 ? effort_[i] - weight[i] : effort_[i] + weight[i]);
    force = std::min(force, room / std::abs(h));
  }
  stop.surely = force * row.mobility / options_.mass_uncertainty;
  return stop;
}

double EntryBarrier::allowed(double d, double a) const noexcept {
  const double t = reaction_ + 0.5 * step_;
  if (d < 0.0) return totals_.energy > 0.0 ? std::max(d / t, -options_.recovery) : 0.0;
  return braked_within(d, a, t);
}

void EntryBarrier::count(const LeastConstraint& problem, std::span<const double> efforts) noexcept {
  const double share = problem.share();            // of what acts in this tick
  const double withheld = problem.share(efforts);  // of what the wall takes off
  double force = 0.0;                              // on one pair
  for (std::size_t k = 0; k < held(problem); ++k) {
    const LeastConstraint::Row& bound = problem.rows()[k];
    const PairId pair = rows_.all()[k].pair;
    if (!pair.valid()) continue;
    if (k == 0 || rows_.all()[k - 1].pair != pair) force = 0.0;
    // Between walls that cannot be kept together the duals grow without bound.
    const double most_push = 2.0 * stops_[k].at_most / bound.mobility;
    const double pushed = std::min(withheld * bound.force, std::max(0.0, most_push));
    const double rate = rows_.all()[k].rate;
    const bool gives = bound.least_rate > 0.0;
    totals_.energy -= period_ * share * bound.force * (gives ? rate : std::min(rate, 0.0));
    force += pushed;
    double& most = withstood_[static_cast<std::size_t>(pair.index)];
    most = std::max(most, force);
    if (force > force_) {
      force_ = force;
      pushed_ = pair;
    }
  }
  totals_.peak_force = std::max(totals_.peak_force, force_);
  if (force_ > 0.0) ++totals_.ticks;
}

double EntryBarrier::soon(const BarrierRow& row, double freely, double after) const noexcept {
  const double late = delay_ * period_;
  const double then = std::min(0.0, row.rate + (freely - row.rate) * late / (late + step_));
  return row.gap + margin() + late * std::min(row.rate, then) +
         0.5 * step_ * (then + std::min(0.0, after));
}

double EntryBarrier::stopping_distance(double after, double a) const noexcept {
  const double approach = std::max(0.0, -after);
  return 0.5 * slew_time_ * approach + 0.5 * approach * approach / std::max(a, 1e-9);
}

Status EntryBarrier::judge(const LeastConstraint& problem) noexcept {
  proof_.left_out = left_out_;
  bool is_lost = false;
  for (std::size_t k = 0; k < held(problem); ++k) {
    const BarrierRow& row = rows_.all()[k];
    const LeastConstraint::Row& bound = problem.rows()[k];
    if (!row.pair.valid()) continue;
    const double after = problem.rate_after(bound);
    const double gap = soon(row, bound.rate, after);
    const double proven = gap - stopping_distance(after, stops_[k].surely);
    const double possible = gap - stopping_distance(after, stops_[k].at_most);
    if (proven < proof_.margin) {
      proof_.margin = proven;
      proof_.pair = row.pair;
    }
    if (gap < margin() && std::min(proven, possible) < 0.0) is_lost = true;
  }
  if (is_lost) ++totals_.lost;
  return is_lost ? status::hold_lost : 0U;
}

}  // namespace repel
