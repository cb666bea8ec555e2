// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What happens between the ticks of a run, each with a tick, so a log shows it at the same tick in
/// every repetition.
#pragma once

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <utility>
#include <vector>

#include <repel/runs/records/depth_picture.hpp>
#include <repel/world/world.hpp>

namespace repel::runs {

/// From the loop's thread, between ticks, to the thread of the log. With a lock: not for the tick.
template <class What>
class Dated {
 public:
  /// It belongs to the next tick that is dated.
  void note(What what) { fresh_.push_back(std::move(what)); }
  /// Sets this tick for those noted since the last call. To be called before it is logged.
  void date(std::int64_t tick) {
    if (fresh_.empty()) return;
    const std::lock_guard lock(mutex_);
    for (What& what : fresh_) dated_.emplace_back(tick, std::move(what));
    fresh_.clear();
  }
  /// Those up to this tick that have not been taken, in their order. For the thread of the log.
  [[nodiscard]] std::vector<What> take(std::int64_t tick) {
    const std::lock_guard lock(mutex_);
    std::size_t count = 0;
    while (count < dated_.size() && dated_[count].first <= tick) ++count;
    const auto end = dated_.begin() + static_cast<std::ptrdiff_t>(count);
    std::vector<What> taken;
    for (auto it = dated_.begin(); it != end; ++it) taken.push_back(std::move(it->second));
    dated_.erase(dated_.begin(), end);
    return taken;
  }

 private:
  std::vector<What> fresh_;  ///< of the loop's thread alone
  std::mutex mutex_;
  std::vector<std::pair<std::int64_t, What>> dated_;
};

/// A shape that a part gets in one of the next ticks.
struct NewShape {
  PartId part;
  Shape shape;
};

/// What a recording shows beside its ticks.
struct BesideTicks {
  Dated<NewShape> shapes;
  Dated<DepthPicture> pictures;

  /// See Dated.
  void date(std::int64_t tick) {
    shapes.date(tick);
    pictures.date(tick);
  }
};

}  // namespace repel::runs
