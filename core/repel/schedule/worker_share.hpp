/// @file
/// The pairs that one worker evaluates: some blocks, and the search that finds their candidates.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <deque>
#include <limits>
#include <memory>

#include <repel/pairs/pair_search.hpp>
#include <repel/schedule/pair_block.hpp>

namespace repel::detail {

/// Every `stride`-th block of a world, starting with `index`. The result of a block depends only on
/// the motions it has been run with. So the forces of the world, summed block by block, are bitwise
/// the same for any number of workers that have been run with the same motions.
class WorkerShare {
 public:
  /// @param pairs the index of the world's pairs, shared by all workers; if null, every pair is
  /// evaluated at every tick
  WorkerShare(const World& world, const std::shared_ptr<const PairIndex>& pairs,
              const Budget& budget, int index, int stride)
      : budget_(budget),
        blocks_in_all_(PairPartition::blocks_of(world)),
        index_(index),
        stride_(stride),
        poses_(world),
        search_(pairs != nullptr ? pairs : std::make_shared<const PairIndex>()) {
    const int blocks = std::max(1, blocks_in_all_);
    const int all = static_cast<int>(world.pairs().size());
    const int slots = pairs == nullptr ? all : (world.limits().candidates + blocks - 1) / blocks;
    for (int b = index; b < blocks_in_all_; b += stride) {
      blocks_.emplace_back(world, PairPartition{b, blocks_in_all_}, slots, budget);
      if (pairs == nullptr) blocks_.back().track_all();
    }
    if (budget.work_units > 0) {
      units_per_block_ = std::max<std::int64_t>(1, budget.work_units / blocks);
    }
  }

  /// Evaluates every pair once, without a budget, so that each has an answer at the first tick.
  void prime(const Motion& motion) noexcept {
    poses_.begin_tick();
    for (PairBlock& block : blocks_) block.prime(motion, poses_);
    find_candidates(motion);
    for (PairBlock& block : blocks_) block.run(motion, poses_, no_limit, Clock::time_point::max());
  }

  /// Runs one tick. It starts with the block after the one in which the last overrun occurred, so
  /// that a block that needs the whole budget leaves the next tick to the others.
  void run(const Motion& motion) noexcept {
    const Clock::time_point deadline =
        budget_.wall.count() > 0 ? Clock::now() + budget_.wall : Clock::time_point::max();
    poses_.begin_tick();
    find_candidates(motion);
    const std::size_t count = blocks_.size();
    const std::size_t begin = next_;
    bool late = false;
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t b = begin + k < count ? begin + k : begin + k - count;
      blocks_[b].run(motion, poses_, units_per_block_, deadline);
      if (!late && deadline != Clock::time_point::max() && Clock::now() >= deadline) {
        late = true;
        next_ = (b + 1) % count;
      }
    }
  }

  /// Repeats the work of the last tick on the first few near pairs to warm the CPU caches, without
  /// other effects.
  void rehearse(const Motion& motion) noexcept {
    int pairs = rehearsed_pairs;
    for (PairBlock& block : blocks_) pairs -= block.rehearse(motion, poses_, pairs);
  }

  [[nodiscard]] const std::deque<PairBlock>& blocks() const noexcept { return blocks_; }

  /// Calls see(NearPair) for each pair that was near at `run` with the same motion.
  template <class See>
  void for_each_near(const Motion& motion, const See& see) const noexcept {
    for (const PairBlock& block : blocks_) block.for_each_near(motion, see);
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr int rehearsed_pairs = 32;
  static constexpr std::int64_t no_limit = std::numeric_limits<std::int64_t>::max();

  /// Passes the pairs found by the search to the blocks of this worker, and ignores all others.
  struct Sink {
    bool take(PairId id, std::int32_t list, double distance) noexcept {
      const int block = PairPartition::block_of(id, share.blocks_in_all_);
      if (block % share.stride_ != share.index_) return true;
      return share.blocks_[block / share.stride_].take(id, list, distance, motion, share.poses_);
    }
    int end(std::int32_t list) noexcept {
      int kept = 0;
      for (PairBlock& block : share.blocks_) kept += block.end(list);
      return kept;
    }
    WorkerShare& share;
    const Motion& motion;
  };

  void find_candidates(const Motion& motion) noexcept {
    for (PairBlock& block : blocks_) block.begin_tick(motion.tick);
    search_.run(motion, Sink{*this, motion});
  }

  Budget budget_;
  int blocks_in_all_;
  int index_;
  int stride_;
  std::int64_t units_per_block_ = no_limit;
  PartPoses poses_;
  PairSearch search_;
  std::deque<PairBlock> blocks_;  // a deque, since PairBlock is not movable
  std::size_t next_ = 0;
};

}  // namespace repel::detail
