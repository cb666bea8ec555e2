// SPDX-License-Identifier: BSD-3-Clause
#include "conduct.hpp"

#include <algorithm>
#include <cmath>
#include <csetjmp>
#include <csignal>

#include "paths.hpp"

namespace repel::bench {

namespace {

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Angle [rad]; NaN if a direction is missing.
double angle(const Vec3& a, const Vec3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// Queries a library that may abort the process, as FCL does when its own assertions fail, mostly
/// in shallow overlap. Memory the library held at the abort is leaked.
class Guarded {
 public:
  explicit Guarded(std::unique_ptr<Rival> rival) : rival_(std::move(rival)) {
    std::signal(SIGABRT, [](int) { siglongjmp(before_, 1); });
  }
  Guarded(const Guarded&) = delete;
  Guarded& operator=(const Guarded&) = delete;
  ~Guarded() { std::signal(SIGABRT, SIG_DFL); }

  /// The distance is NaN if the library aborts.
  Answer answer(const Ask& ask) {
    if (sigsetjmp(before_, 1) != 0) return {.distance = std::nan("")};
    return rival_->answer(ask, Start::warm);
  }

 private:
  static inline sigjmp_buf before_;
  std::unique_ptr<Rival> rival_;
};

bool is_wrong(const Answer& answer, const Truth& truth) {
  const double slack = 1e-15 * truth.size;
  return !(answer.distance >= (1.0 + 1e-6) * truth.distance - slack) ||
         !(answer.lower <= truth.distance + slack) || !(answer.upper >= truth.distance - slack) ||
         !answer.extraction_W.allFinite();
}

void press(const Library& library, const CheckedTask& presses, Conduct& conduct) {
  const Task& task = presses.task;
  Guarded rival(library.load(task, library.tolerance));
  std::vector<double> dead_zones;
  for (std::size_t pair = 0; pair < task.pairs.size(); ++pair) {
    double dead_zone = 0.0;
    for (std::size_t tick = 0; tick < task.ticks(); ++tick) {
      const Truth& truth = presses.truth({pair, tick});
      const Answer answer = rival.answer({pair, tick});
      const bool felt = answer.distance < 0.01 * truth.distance;  // false for NaN
      if (!felt) dead_zone = std::max(dead_zone, -truth.distance);
      conduct.wrong += library.ours && is_wrong(answer, truth) ? 1 : 0;
    }
    dead_zones.push_back(dead_zone);
  }
  conduct.median_dead_zone = median(dead_zones);
  conduct.worst_dead_zone = *std::max_element(dead_zones.begin(), dead_zones.end());
}

void sweep(const Library& library, const Task& task, Conduct& conduct) {
  Guarded rival(library.load(task, library.tolerance));
  conduct.excess = -std::numeric_limits<double>::infinity();
  std::vector<double> turns;
  for (std::size_t pair = 0; pair < task.pairs.size(); ++pair) {
    double turn = 0.0;
    Answer before = rival.answer({pair, 0});
    for (std::size_t tick = 1; tick < task.ticks(); ++tick) {
      const Answer answer = rival.answer({pair, tick});
      if (library.ours && !std::isfinite(answer.distance)) ++conduct.wrong;
      const double change = std::abs(answer.distance - before.distance);
      const bool overlap = std::min(answer.distance, before.distance) < 0.0;
      if (overlap && std::isfinite(change)) {
        const double excess = change - motion(task, {pair, tick});
        if (excess > conduct.excess) conduct.steepest = {pair, tick};
        conduct.excess = std::max(conduct.excess, excess);
      }
      if (std::max(answer.distance, before.distance) < 0.0) {
        turn = std::max(turn, angle(answer.extraction_W, before.extraction_W));
      }
      before = answer;
    }
    turns.push_back(turn);
  }
  conduct.median_turn = median(turns);
  conduct.turn = *std::max_element(turns.begin(), turns.end());
}

}  // namespace

Conduct conduct_of(const Library& library, const CheckedTask& presses, const Task& sweeps) {
  Conduct conduct;
  press(library, presses, conduct);
  sweep(library, sweeps, conduct);
  return conduct;
}

}  // namespace repel::bench
