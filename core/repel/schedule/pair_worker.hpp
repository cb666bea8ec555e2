/// @file
/// One worker of the coprocessor: a share of the pair blocks, and the search that tells them which
/// pairs to watch.
#pragma once

#include <algorithm>
#include <chrono>
#include <memory>
#include <utility>
#include <vector>

#include <repel/schedule/pair_block.hpp>
#include <repel/schedule/pair_search.hpp>

namespace repel::detail {

/// Owns every `stride`-th block of the world, beginning with `index`. A block's result depends on
/// the motions it has seen alone, so that the forces of the world, summed block by block, are
/// bitwise the same for any number of workers that have seen the same.
class PairWorker {
 public:
  /// Blocks of one world: enough to share among the threads of a large machine. Each costs a tick a
  /// little even if nothing in it is near.
  static constexpr int most_blocks = 8;

  /// @param pairs the index of the world's pairs, shared by all workers; without one every pair is
  /// evaluated at every tick
  PairWorker(const World& world, const std::shared_ptr<const PairIndex>& pairs,
             const Budget& budget, int index, int stride)
      : budget_(budget),
        blocks_in_all_(blocks_of(world)),
        index_(index),
        stride_(stride),
        poses_(world),
        search_(pairs != nullptr ? pairs : std::make_shared<const PairIndex>()) {
    const int blocks = std::max(1, blocks_in_all_);
    const int all = static_cast<int>(world.pairs().size());
    const int slots = pairs == nullptr ? all : (world.limits().candidates + blocks - 1) / blocks;
    for (int b = index; b < blocks_in_all_; b += stride) {
      blocks_.emplace_back(world, PairShare{b, blocks_in_all_}, slots, budget);
      if (pairs == nullptr) blocks_.back().watch_all();
    }
    if (budget.work_units > 0) {
      units_per_block_ = std::max<std::int64_t>(1, budget.work_units / blocks);
    }
  }

  /// How many blocks the pairs of a world make: no more than threads may ever share them.
  [[nodiscard]] static int blocks_of(const World& world) noexcept {
    return blocks_of(static_cast<int>(world.pairs().size()), world.limits().threads);
  }
  [[nodiscard]] static int blocks_of(int pairs, int threads) noexcept {
    const int runs = (pairs + PairShare::run - 1) / PairShare::run;
    return std::min({most_blocks, std::max(1, threads), runs});
  }

  /// Every pair once, whatever it costs, so that no pair enters the first tick unknown.
  void prime(const Motion& motion) noexcept {
    poses_.begin();
    for (PairBlock& block : blocks_) block.prime(motion, poses_);
    find_candidates(motion);
    for (PairBlock& block : blocks_) block.run(motion, poses_, no_limit, Clock::time_point::max());
  }

  /// One tick, beginning after the block at which the last one ran out of time: a block that takes
  /// the whole budget goes on where it stopped when its turn comes again.
  void run(const Motion& motion) noexcept {
    const Clock::time_point deadline =
        budget_.wall.count() > 0 ? Clock::now() + budget_.wall : Clock::time_point::max();
    poses_.begin();
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

  /// Does the work of a tick on the first few near pairs and forgets it.
  void rehearse(const Motion& motion) noexcept {
    int pairs = rehearsed_pairs;
    for (PairBlock& block : blocks_) pairs -= block.rehearse(motion, poses_, pairs);
  }

  [[nodiscard]] const std::vector<PairBlock>& blocks() const noexcept { return blocks_; }

  /// see(NearPair) for each pair that is near since `run` at the same motion.
  template <class See>
  void for_each_near(const Motion& motion, const See& see) const noexcept {
    for (const PairBlock& block : blocks_) block.for_each_near(motion, see);
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr int rehearsed_pairs = 32;
  static constexpr std::int64_t no_limit = std::numeric_limits<std::int64_t>::max();

  /// Hands what the search finds to the blocks of this worker.
  struct Sink {
    bool take(PairId id, std::int32_t seeker, double distance) noexcept {
      const int block = PairShare::block_of(id, worker.blocks_in_all_);
      if (block % worker.stride_ != worker.index_) return true;
      return worker.blocks_[block / worker.stride_].take(id, seeker, distance, motion,
                                                         worker.poses_);
    }
    int end(std::int32_t seeker) noexcept {
      int kept = 0;
      for (PairBlock& block : worker.blocks_) kept += block.end(seeker);
      return kept;
    }
    PairWorker& worker;
    const Motion& motion;
  };

  void find_candidates(const Motion& motion) noexcept {
    for (PairBlock& block : blocks_) block.begin(motion.tick);
    search_.run(motion, Sink{*this, motion});
  }

  Budget budget_;
  int blocks_in_all_;
  int index_;
  int stride_;
  std::int64_t units_per_block_ = no_limit;
  PartPoses poses_;
  PairSearch search_;
  std::vector<PairBlock> blocks_;
  std::size_t next_ = 0;
};

}  // namespace repel::detail
