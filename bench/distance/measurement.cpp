// SPDX-License-Identifier: BSD-3-Clause
#include "measurement.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>

namespace repel::bench {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// [s] Cost of reading the clock twice, subtracted from every sample.
double clock_cost() {
  static const double cost = [] {
    std::vector<double> readings(10001);
    for (double& reading : readings) reading = seconds_since(Clock::now());
    std::nth_element(readings.begin(), readings.begin() + 5000, readings.end());
    return readings[5000];
  }();
  return cost;
}

double quantile(const std::vector<double>& sorted, double q) {
  if (sorted.empty()) return 0.0;
  const auto last = static_cast<double>(sorted.size() - 1);
  return sorted[static_cast<std::size_t>(std::ceil(q * last))];
}

}  // namespace

void Measurement::check() {
  std::vector<double> relative;
  std::vector<double> share;
  const bool claims_value = !task_->task.overlap || library_.exact_depths;
  if (start_ == Start::warm) rival_->run(task_->asks, start_);
  for (const Ask& ask : task_->asks) {
    const Truth& truth = task_->truth(ask);
    const Answer answer = rival_->answer(ask, start_);
    ++verdict_.asked;
    if (!std::isfinite(answer.distance)) {
      ++verdict_.missing;
      ++verdict_.wrong_by_size;
      ++verdict_.wrong_by_distance;
      continue;
    }
    // The exact value itself is rounded to double.
    const double slack = 1e-15 * truth.size;
    const bool outside =
        answer.lower > truth.distance + slack || answer.upper < truth.distance - slack;
    verdict_.outside += outside ? 1 : 0;
    share.push_back(answer.distance / truth.distance);
    const double error = std::abs(answer.distance - truth.distance);
    relative.push_back(error / std::abs(truth.distance));
    verdict_.too_deep += task_->task.overlap && library_.ours && share.back() > 1.0 + 1e-6 ? 1 : 0;
    if (!claims_value) continue;
    verdict_.wrong_by_size += error > 1e-6 * truth.size ? 1 : 0;
    verdict_.wrong_by_distance += relative.back() > 1e-6 ? 1 : 0;
    verdict_.worst_error = std::max(verdict_.worst_error, error);
  }
  std::sort(relative.begin(), relative.end());
  std::sort(share.begin(), share.end(), std::greater<>());
  verdict_.median_share = quantile(share, 0.5);
  verdict_.low_share = quantile(share, 0.95);
  verdict_.median_relative = quantile(relative, 0.5);
  verdict_.high_relative = quantile(relative, 0.95);
  verdict_.worst_relative = quantile(relative, 1.0);
}

double Measurement::timed_pass() {
  double total = 0.0;
  const std::span<const Ask> asks = task_->asks;
  const std::size_t batch = task_->task.batch;
  for (std::size_t i = 0; i < asks.size(); i += batch) {
    const auto some = asks.subspan(i, std::min(batch, asks.size() - i));
    const Clock::time_point start = Clock::now();
    rival_->run(some, start_);
    const double seconds = std::max(0.0, seconds_since(start) - clock_cost());
    samples_.push_back(1e9 * seconds / static_cast<double>(some.size()));
    total += seconds;
  }
  return total;
}

void Measurement::run(benchmark::State& state) {
  if (!rival_) {
    rival_ = library_.load(task_->task, tolerance_);
    check();
  }
  rival_->run(task_->asks, start_);  // Warm-up: caches and warm starts as in the middle of a run.
  for (auto _ : state) state.SetIterationTime(timed_pass());
  const Cost c = cost();
  state.counters["p50_ns"] = c.p50;
  state.counters["p99_ns"] = c.p99;
  state.counters["p999_ns"] = c.p999;
  state.counters["worst_ns"] = c.worst;
  state.counters["samples"] = static_cast<double>(samples_.size());
  state.counters["asked"] = verdict_.asked;
  state.counters["wrong_by_size"] = verdict_.wrong_by_size;
  state.counters["wrong_by_distance"] = verdict_.wrong_by_distance;
  state.counters["missing"] = verdict_.missing;
  state.counters["too_deep"] = verdict_.too_deep;
  state.counters["outside_bracket"] = verdict_.outside;
  state.counters["worst_error_m"] = verdict_.worst_error;
  state.counters["worst_relative_error"] = verdict_.worst_relative;
  state.counters["median_relative_error"] = verdict_.median_relative;
  state.counters["p95_relative_error"] = verdict_.high_relative;
  state.counters["median_share"] = verdict_.median_share;
  state.counters["p5_share"] = verdict_.low_share;
  state.counters["tolerance"] = tolerance_;
}

Cost Measurement::cost() const {
  std::vector<double> sorted = samples_;
  std::sort(sorted.begin(), sorted.end());
  return {quantile(sorted, 0.5), quantile(sorted, 0.99), quantile(sorted, 0.999),
          quantile(sorted, 1.0)};
}

}  // namespace repel::bench
