// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// One line of the table: a library on a task, checked first, then timed.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "rival.hpp"

namespace repel::bench {

/// A task with its exact answers, computed on first use.
struct CheckedTask {
  Task task;
  std::vector<Ask> asks;
  std::vector<Truth> truths;  ///< [tick * pairs + pair]

  explicit CheckedTask(Task drawn)
      : task(std::move(drawn)), asks(task.asks()), truths(exact_answers(task)) {}
  [[nodiscard]] const Truth& truth(const Ask& ask) const {
    return truths[ask.tick * task.pairs.size() + ask.pair];
  }
};

/// Comparison of the answers with the exact ones.
struct Verdict {
  int asked = 0;
  int wrong_by_size = 0;        ///< error above 1e-6 of the size of the larger solid
  int wrong_by_distance = 0;    ///< error above 1e-6 of the distance itself
  int missing = 0;              ///< no finite answer: counted as wrong in both ways
  int too_deep = 0;             ///< repel only, where it claims never to exceed the true depth
  int outside = 0;              ///< the exact value is outside the claimed bracket
  double worst_error = 0.0;     ///< [m]
  double worst_relative = 0.0;  ///< error / |distance|
  double median_relative = 0.0;
  double high_relative = 0.0;  ///< 95 % quantile
  double median_share = 0.0;   ///< answered distance divided by the exact one
  double low_share = 0.0;      ///< 5 % quantile

  /// Number of wrong answers; if not 0, the table shows no time.
  [[nodiscard]] int wrong() const {
    return std::max({wrong_by_size, wrong_by_distance, outside, too_deep});
  }
};

/// Percentiles of the cost of one query, over batches of different queries [ns].
struct Cost {
  double p50 = 0.0;
  double p99 = 0.0;
  double p999 = 0.0;
  double worst = 0.0;
};

class Measurement {
 public:
  Measurement(const Library& library, std::shared_ptr<CheckedTask> task, Start start,
              double tolerance)
      : library_(library), task_(std::move(task)), start_(start), tolerance_(tolerance) {}

  /// Runs the whole task once per iteration. The first call loads the library and checks every
  /// answer; passes on exceptions of the library.
  void run(benchmark::State& state);

  [[nodiscard]] const Library& library() const { return library_; }
  [[nodiscard]] const Task& task() const { return task_->task; }
  [[nodiscard]] Start start() const { return start_; }
  [[nodiscard]] double tolerance() const { return tolerance_; }
  [[nodiscard]] const Verdict& verdict() const { return verdict_; }
  /// Over all samples so far.
  [[nodiscard]] Cost cost() const;

 private:
  void check();
  double timed_pass();

  const Library& library_;
  std::shared_ptr<CheckedTask> task_;
  Start start_;
  double tolerance_;
  std::unique_ptr<Rival> rival_;
  Verdict verdict_;
  std::vector<double> samples_;  ///< [ns] per query
};

}  // namespace repel::bench
