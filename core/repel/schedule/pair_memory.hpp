/// @file
/// What a block of pairs remembers of them: everything of those that have a slot, and of the others
/// their extremes.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include <repel/force/passage.hpp>
#include <repel/schedule/pair_answer.hpp>
#include <repel/schedule/pair_forces.hpp>
#include <repel/world/world.hpp>

namespace repel::detail {

/// Which of a world's pairs a block owns: every `stride`-th run of 64, so that neighbours in a
/// scene are spread over the blocks.
struct PairShare {
  int index = 0;
  int stride = 1;

  static constexpr int run = 64;

  [[nodiscard]] static int block_of(PairId id, int stride) noexcept {
    return id.index / run % stride;
  }
  /// Where a pair stands among those of its block.
  [[nodiscard]] int place_of(PairId id) const noexcept {
    return id.index / run / stride * run + id.index % run;
  }
  [[nodiscard]] PairId pair_at(int place) const noexcept {
    return {(place / run * stride + index) * run + place % run};
  }
  /// How many of so many pairs the block owns.
  [[nodiscard]] int count_of(int pairs) const noexcept {
    const int whole = pairs / (run * stride) * run;
    return whole + std::clamp(pairs % (run * stride) - index * run, 0, run);
  }
};

/// What decides whether a pair is near: kept apart from the rest, so that thousands of far pairs
/// fit into the cache.
struct PairWatch {
  BodyId body_a;
  BodyId body_b;
  double due_at = -std::numeric_limits<double>::infinity();  ///< [m] of travel of both bodies
  PairId pair;
  std::int32_t seeker = -1;  ///< on whose list it is; -1: on none
  std::int32_t seat = -1;    ///< among the contacts; -1: not one of them
  bool taken = false;        ///< again, while the list is renewed
};

/// What goes on from one tick to the next while a pair is within range.
struct PairCourse {
  WarmStart warm;
  Passage passage;
};

/// A slot for each pair while there are enough; then a pair without one takes that of a pair that
/// is on no list. All memory is taken at construction.
class PairMemory {
 public:
  static constexpr std::int32_t none = -1;

  /// @param slots for at most so many pairs, at least 0
  PairMemory(const World& world, PairShare share, int slots)
      : world_(&world),
        share_(share),
        slot_of_(share.count_of(static_cast<int>(world.pairs().size())), none),
        extremes_(slot_of_.size()),
        slots_(std::min(slots, pairs())),
        watches_(slots_ + 1),
        answers_(slots_ + 1),
        courses_(slots_ + 1) {}

  [[nodiscard]] int pairs() const noexcept { return static_cast<int>(slot_of_.size()); }
  [[nodiscard]] int slots() const noexcept { return slots_; }
  [[nodiscard]] const PairShare& share() const noexcept { return share_; }
  /// The slot of a pair, or none.
  [[nodiscard]] int slot_of(PairId id) const noexcept { return slot_of_[share_.place_of(id)]; }
  /// The slot beyond all others is lent to one pair at a time, which is forgotten at the next loan.
  [[nodiscard]] bool is_lent(int slot) const noexcept { return slot == slots_; }

  /// The slot of a pair, a new one if it had none. Cost: in a memory that is full a look at each
  /// slot until one can be had.
  int slot_for(PairId id) noexcept {
    int slot = slot_of(id);
    if (slot == none) {
      slot = free_slot();
      assign(slot, id);
    }
    return slot;
  }

  /// Puts the pair of a slot on the list of a seeker; false when it was on one.
  bool enlist(int slot, std::int32_t seeker) noexcept {
    const bool is_new = watches_[slot].seeker == none;
    listed_ += is_new ? 1 : 0;
    watches_[slot].seeker = seeker;
    return is_new;
  }
  /// Takes it off: its slot can go to another pair.
  void strike(int slot) noexcept {
    watches_[slot].seeker = none;
    --listed_;
  }

  [[nodiscard]] PairWatch& watch(int slot) noexcept { return watches_[slot]; }
  [[nodiscard]] const PairWatch& watch(int slot) const noexcept { return watches_[slot]; }
  [[nodiscard]] PairAnswer& answer(int slot) noexcept { return answers_[slot]; }
  [[nodiscard]] const PairAnswer& answer(int slot) const noexcept { return answers_[slot]; }
  [[nodiscard]] PairCourse& course(int slot) noexcept { return courses_[slot]; }
  [[nodiscard]] const PairCourse& course(int slot) const noexcept { return courses_[slot]; }
  [[nodiscard]] PairExtremes& extremes(PairId id) noexcept {
    return extremes_[share_.place_of(id)];
  }
  [[nodiscard]] const PairExtremes& extremes(PairId id) const noexcept {
    return extremes_[share_.place_of(id)];
  }

 private:
  [[nodiscard]] int free_slot() noexcept {
    for (int tried = 0; listed_ < slots_ && tried < slots_; ++tried) {
      const int slot = hand_;
      hand_ = hand_ + 1 < slots_ ? hand_ + 1 : 0;
      if (watches_[slot].seeker == none) return slot;
    }
    return slots_;
  }

  void assign(int slot, PairId id) noexcept {
    PairWatch& watch = watches_[slot];
    if (!is_lent(slot)) {
      if (watch.pair.valid()) slot_of_[share_.place_of(watch.pair)] = none;
      slot_of_[share_.place_of(id)] = slot;
    }
    const Pair& pair = world_->pair(id);
    watch = {};
    watch.body_a = world_->part(pair.a).body;
    watch.body_b = world_->part(pair.b).body;
    watch.pair = id;
    answers_[slot] = {};
    courses_[slot] = {};
  }

  const World* world_;
  PairShare share_;
  std::vector<std::int32_t> slot_of_;   ///< by place in the share
  std::vector<PairExtremes> extremes_;  ///< by place in the share
  int slots_;
  std::vector<PairWatch> watches_;  ///< by slot, as the next two
  std::vector<PairAnswer> answers_;
  std::vector<PairCourse> courses_;
  int listed_ = 0;  ///< slots that are on a list
  int hand_ = 0;    ///< the slot that is tried next for a new pair
};

}  // namespace repel::detail
