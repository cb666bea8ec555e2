/// @file
/// One line of the table: a library on a task, checked first and timed after.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "rival.hpp"

namespace repel::bench {

/// A task with its exact answers, drawn when it is first needed.
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

/// How the answers compare with the exact ones.
struct Verdict {
  int asked = 0;
  int wrong_by_size = 0;        ///< off by more than 1e-6 of the larger solid
  int wrong_by_distance = 0;    ///< off by more than 1e-6 of the distance itself
  int missing = 0;              ///< no finite answer: wrong in both ways
  int too_deep = 0;             ///< ours, where it claims never to be deeper than the truth
  int outside = 0;              ///< the truth lies outside the bracket that was claimed
  double worst_error = 0.0;     ///< [m]
  double worst_relative = 0.0;  ///< error / |distance|
  double median_relative = 0.0;
  double high_relative = 0.0;  ///< only 5 % are larger
  double median_share = 0.0;   ///< of the exact distance, in what was answered
  double low_share = 0.0;      ///< only 5 % are smaller

  /// Answers that earn no time.
  [[nodiscard]] int wrong() const {
    return std::max({wrong_by_size, wrong_by_distance, outside, too_deep});
  }
};

/// Percentiles of what one question costs, over batches of different questions [ns].
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
  /// answer; throws what the library throws.
  void run(benchmark::State& state);

  [[nodiscard]] const Library& library() const { return library_; }
  [[nodiscard]] const Task& task() const { return task_->task; }
  [[nodiscard]] Start start() const { return start_; }
  [[nodiscard]] double tolerance() const { return tolerance_; }
  [[nodiscard]] const Verdict& verdict() const { return verdict_; }
  /// Of all samples so far.
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
  std::vector<double> samples_;  ///< [ns] a question
};

}  // namespace repel::bench
