// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The tap: copies of every tick for displays and logs, without blocking the loop.
#pragma once

#include <chrono>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <repel/base/mailbox.hpp>
#include <repel/base/ring.hpp>
#include <repel/loop/record.hpp>
#include <repel/schedule/coprocessor.hpp>

namespace repel {

/// How long a tick took, and how late it began.
struct TickTimes {
  std::chrono::nanoseconds late{0};     ///< after it was due
  std::chrono::nanoseconds compute{0};  ///< of the tick alone
};

/// All data of one tick. Its vectors have their size from set-up on.
struct Snapshot {
  std::vector<TickRecord> arms;        ///< of each arm that shares the world, in their order
  std::vector<Pose> X_WB;              ///< [m] by BodyId
  std::vector<std::uint8_t> is_there;  ///< by BodyId: 0 while it is absent
  std::vector<NearPair> pairs;  ///< fixed size; the first `pair_count` are valid, nearest first
  int pair_count = 0;           ///< valid entries of `pairs`
  int pairs_omitted = 0;        ///< further near pairs, farther than all of these
  TickTimes times;              ///< of the tick
  std::chrono::steady_clock::time_point made;  ///< time of this copy, after the tick

  /// The valid pairs, nearest first.
  [[nodiscard]] std::span<const NearPair> near() const noexcept;
};

/// A few numbers of one tick.
struct TickSample {
  std::int64_t tick = 0;                                     ///< its number, from 0
  double nearest = std::numeric_limits<double>::infinity();  ///< [m] least signed distance
  double force = 0.0;                                        ///< [N] on the tool of the first arm
  TickTimes times;                                           ///< of the tick
  Status status = 0;                                         ///< of all arms together
};

/// Capacities of a tap.
struct TapOptions {
  int arms = 1;    ///< that share the world
  int pairs = 64;  ///< most in a snapshot
  /// Period of the pictures.
  std::chrono::nanoseconds picture_period{1000000000 / 60};
  std::size_t samples = 1024;  ///< most waiting to be read
  std::size_t log = 0;         ///< most snapshots waiting to be read; 0: no log is kept
};

/// Three outputs, each for one reader thread: `pictures` has the newest snapshot, `samples` a few
/// numbers of every tick, `log` a snapshot of every tick. The loop writes them after a tick and
/// never waits: pictures not read are overwritten, entries for which a ring has no room are dropped
/// and counted there. Allocates at construction only.
class Tap {
 public:
  /// @throws SetupError for a number out of range
  explicit Tap(const World& world, const TapOptions& options = {});

  /// Continues with another world that has the same bodies and pairs.
  void watch(const World& world) noexcept { world_ = &world; }

  /// Called by the loop's thread after a tick. Cost: a sample; for a picture or a log also a copy
  /// of the poses, records and near pairs.
  void note(const Coprocessor& coprocessor, std::span<const TickRecord* const> arms,
            const TickTimes& times) noexcept;

  /// Makes a picture of the last tick regardless of the picture period, for use before a pause.
  void show(const Coprocessor& coprocessor, std::span<const TickRecord* const> arms,
            const TickTimes& times) noexcept;

  /// For the thread that draws.
  [[nodiscard]] Mailbox<Snapshot>& pictures() noexcept { return pictures_; }
  /// For the thread that plots.
  [[nodiscard]] Ring<TickSample>& samples() noexcept { return samples_; }
  /// For the thread that writes every tick.
  [[nodiscard]] Ring<Snapshot>& log() noexcept { return log_; }
  /// Something is written to `log`.
  [[nodiscard]] bool has_log() const noexcept { return has_log_; }

 private:
  [[nodiscard]] static Snapshot room_for(const World& world, const TapOptions& options);

  [[nodiscard]] static bool is_nearer(const NearPair& a, const NearPair& b) noexcept;

  void fill(Snapshot& s, const Coprocessor& coprocessor, std::span<const TickRecord* const> arms,
            const TickTimes& times) const noexcept;

  const World* world_;
  std::chrono::nanoseconds period_;
  std::chrono::steady_clock::time_point next_picture_;
  Mailbox<Snapshot> pictures_;
  Ring<TickSample> samples_;
  bool has_log_;
  Ring<Snapshot> log_;
};

}  // namespace repel
