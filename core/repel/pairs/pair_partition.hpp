/// @file
/// The partition of a world's pairs into blocks, whose forces are summed in a fixed order.
#pragma once

#include <algorithm>

#include <repel/base/ids.hpp>
#include <repel/world/world.hpp>

namespace repel::detail {

/// The pairs of block number `block` of `blocks`: every `blocks`-th run of 64 pairs, so that
/// neighbours in a scene are spread over the blocks.
struct PairPartition {
  int block = 0;
  int blocks = 1;

  static constexpr int run = 64;
  /// Upper limit of the number of blocks, which also limits the useful number of threads. Each
  /// block adds a small cost per tick even if none of its pairs is near.
  static constexpr int most_blocks = 8;

  /// The number of blocks of a world: at most `Limits::threads`.
  [[nodiscard]] static int blocks_of(const World& world) noexcept {
    return blocks_of(static_cast<int>(world.pairs().size()), world.limits().threads);
  }
  [[nodiscard]] static int blocks_of(int pairs, int threads) noexcept {
    const int runs = (pairs + run - 1) / run;
    return std::min({most_blocks, std::max(1, threads), runs});
  }
  /// The block of a pair.
  [[nodiscard]] static int block_of(PairId id, int blocks) noexcept {
    return id.index / run % blocks;
  }

  /// The position of a pair among those of its block.
  [[nodiscard]] int position_of(PairId id) const noexcept {
    return id.index / run / blocks * run + id.index % run;
  }
  /// The pair at a position.
  [[nodiscard]] PairId pair_at(int position) const noexcept {
    return {(position / run * blocks + block) * run + position % run};
  }
  /// How many pairs the block has if the world has `pairs`.
  [[nodiscard]] int count_of(int pairs) const noexcept {
    const int whole = pairs / (run * blocks) * run;
    return whole + std::clamp(pairs % (run * blocks) - block * run, 0, run);
  }
};

}  // namespace repel::detail
