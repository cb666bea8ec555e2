/// @file
/// One worker of the coprocessor: a share of the pair blocks and the poses they need.
#pragma once

#include <chrono>
#include <vector>

#include <repel/schedule/pair_block.hpp>

namespace repel::detail {

/// Owns every `stride`-th block of the world, beginning with `index`. A block's result depends on
/// its own history alone, so that the forces of the world, summed block by block, are bitwise the
/// same for any number of workers.
class PairWorker {
 public:
  PairWorker(const World& world, const Budget& budget, int index, int stride)
      : world_(&world), budget_(budget), X_WP_(world.parts().size()) {
    const int pairs = static_cast<int>(world.pairs().size());
    const int blocks = (pairs + PairBlock::capacity - 1) / PairBlock::capacity;
    for (int b = index; b < blocks; b += stride) {
      const int first = b * PairBlock::capacity;
      blocks_.emplace_back(world, first, std::min(PairBlock::capacity, pairs - first));
    }
    if (budget.work_units > 0) {
      units_per_block_ = std::max<std::int64_t>(1, budget.work_units / std::max(1, blocks));
    }
    for (std::size_t i = 0; i < X_WP_.size(); ++i) {
      const Part& part = world.parts()[i];
      X_WP_[i] = world.motion().bodies[part.body.index].X_WB * part.X_BP;
      if (part.body != World::fixed) moving_.push_back(static_cast<int>(i));
    }
  }

  /// Every pair once, whatever it costs, so that no pair enters the first tick unknown.
  void prime(const Motion& motion) noexcept {
    place_parts(motion);
    for (PairBlock& block : blocks_) block.run(motion, X_WP_, no_limit, Clock::time_point::max());
  }

  /// One tick, beginning after the block at which the last one ran out of time: a block that takes
  /// the whole budget goes on where it stopped when its turn comes again.
  void run(const Motion& motion) noexcept {
    place_parts(motion);
    const Clock::time_point deadline =
        budget_.wall.count() > 0 ? Clock::now() + budget_.wall : Clock::time_point::max();
    const std::size_t count = blocks_.size();
    const std::size_t begin = next_;
    bool late = false;
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t b = (begin + k) % count;
      blocks_[b].run(motion, X_WP_, units_per_block_, deadline);
      if (!late && deadline != Clock::time_point::max() && Clock::now() >= deadline) {
        late = true;
        next_ = (b + 1) % count;
      }
    }
  }

  /// Does the work of a tick on the first few near pairs and forgets it.
  void rehearse(const Motion& motion) const noexcept {
    int pairs = rehearsed_pairs;
    for (const PairBlock& block : blocks_) pairs -= block.rehearse(motion, X_WP_, pairs);
  }

  [[nodiscard]] const std::vector<PairBlock>& blocks() const noexcept { return blocks_; }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr int rehearsed_pairs = 8;
  static constexpr std::int64_t no_limit = std::numeric_limits<std::int64_t>::max();

  void place_parts(const Motion& motion) noexcept {
    for (const int i : moving_) {
      const Part& part = world_->parts()[i];
      X_WP_[i] = motion.bodies[part.body.index].X_WB * part.X_BP;
    }
  }

  const World* world_;
  Budget budget_;
  std::int64_t units_per_block_ = no_limit;
  std::vector<Pose> X_WP_;  ///< [m] by PartId
  std::vector<int> moving_;
  std::vector<PairBlock> blocks_;
  std::size_t next_ = 0;
};

}  // namespace repel::detail
