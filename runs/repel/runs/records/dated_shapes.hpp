// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// New shapes of parts during a run, each with the tick of its request, so a log shows them at the
/// same tick in every repetition.
#pragma once

#include <cstddef>
#include <cstdint>
#include <iterator>
#include <mutex>
#include <utility>
#include <vector>

#include <repel/world/world.hpp>

namespace repel::runs {

/// From the loop's thread, between ticks, to the thread of the log. With a lock: not for the tick.
class DatedShapes {
 public:
  struct Entry {
    std::int64_t tick = 0;
    PartId part;
    Shape shape;
  };

  /// A part gets this shape in one of the next ticks.
  void note(PartId part, const Shape& shape) { fresh_.push_back({0, part, shape}); }
  /// Sets this tick for those noted since the last call. To be called before it is logged.
  void date(std::int64_t tick) {
    if (fresh_.empty()) return;
    const std::lock_guard lock(mutex_);
    for (Entry& entry : fresh_) {
      entry.tick = tick;
      dated_.push_back(std::move(entry));
    }
    fresh_.clear();
  }
  /// Those up to this tick that have not been taken, in their order. For the thread of the log.
  [[nodiscard]] std::vector<Entry> take(std::int64_t tick) {
    const std::lock_guard lock(mutex_);
    std::size_t count = 0;
    while (count < dated_.size() && dated_[count].tick <= tick) ++count;
    const auto end = dated_.begin() + static_cast<std::ptrdiff_t>(count);
    std::vector<Entry> taken(std::make_move_iterator(dated_.begin()), std::make_move_iterator(end));
    dated_.erase(dated_.begin(), end);
    return taken;
  }

 private:
  std::vector<Entry> fresh_;  ///< of the loop's thread alone
  std::mutex mutex_;
  std::vector<Entry> dated_;
};

}  // namespace repel::runs
