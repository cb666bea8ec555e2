// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The state of the pairs of a world that is kept from tick to tick.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include <repel/contact/pointed_pair.hpp>
#include <repel/force/passage.hpp>
#include <repel/pairs/forces_and_totals.hpp>
#include <repel/pairs/pair_answer.hpp>
#include <repel/world/world.hpp>

namespace repel::detail {

/// Whether a pair is near, and how it is evaluated. Stored apart from the rest of the memory, so
/// that thousands of far pairs fit into the cache.
struct PairTracking {
  BodyId body_a;
  BodyId body_b;
  /// [m] summed travel of both bodies below which the pair cannot be within range
  double due_at = -std::numeric_limits<double>::infinity();
  double reach = 0.0;  ///< [m] distance within which the pair is near
  PairId pair;
  std::int32_t list = -1;  ///< the neighbour list it is on; -1: none
  std::int32_t lane = -1;  ///< of the LaneEvaluator; -1: it is evaluated singly
  bool found = false;      ///< by the running search of its list
  bool is_loose = false;   ///< one of its parts can come and go
};

/// State passed from one evaluation to the next while the pair is within range.
struct PairHistory {
  WarmStart warm{};
  Passage passage{};
  PointedPair pointed{};
};

/// Answers and history of the pairs that have a slot, and the extremes of all pairs. A slot is
/// reused for another pair only when needed, and never while its pair is on a list. All memory is
/// allocated at construction.
class PairMemory {
 public:
  static constexpr std::int32_t none = -1;

  /// @param slots largest number of pairs with a slot, at least 0
  /// @param lookahead [m] by which a pair may be out of its range and yet be near
  PairMemory(const World& world, int slots, double lookahead = 0.0)
      : world_(&world),
        lookahead_(lookahead),
        slot_of_(world.pairs().size(), none),
        extremes_(slot_of_.size()),
        slots_(std::min(slots, pairs())),
        tracking_(slots_ + 1),
        answers_(slots_ + 1),
        histories_(slots_ + 1) {}

  /// How many pairs the world has.
  [[nodiscard]] int pairs() const noexcept { return static_cast<int>(slot_of_.size()); }
  [[nodiscard]] int slots() const noexcept { return slots_; }
  /// The slot of a pair, or none.
  [[nodiscard]] int slot_of(PairId id) const noexcept { return slot_of_[index(id)]; }
  /// True for the one spare slot used when the memory is full: it is overwritten by the next pair
  /// that finds no other slot.
  [[nodiscard]] bool is_temporary(int slot) const noexcept { return slot == slots_; }

  /// Has the part of an answer that bounds the distance brought into the cache, to be read a few
  /// pairs later.
  void prefetch(int slot) const noexcept {
    const auto* const begin = reinterpret_cast<const char*>(&answers_[slot]);
    for (std::size_t line = 0; line < PairAnswer::bytes_of_bound; line += 64) {
      __builtin_prefetch(begin + line);
    }
  }

  /// The slot of a pair; assigns one if it has none. Cost of that: a linear search for a slot whose
  /// pair is on no list, over all slots at worst.
  int slot_for(PairId id) noexcept {
    int slot = slot_of(id);
    if (slot == none) {
      slot = free_slot();
      assign(slot, id);
    }
    return slot;
  }

  /// Forgets what was known of a pair that is on no list, and may have other shapes by now.
  void forget(int slot) noexcept {
    tracking_[slot].due_at = -std::numeric_limits<double>::infinity();
    answers_[slot] = {};
    histories_[slot] = {};
  }

  /// Puts the pair of a slot on a list; false if it was already on one.
  bool add_to_list(int slot, std::int32_t list) noexcept {
    const bool is_new = tracking_[slot].list == none;
    listed_ += is_new ? 1 : 0;
    tracking_[slot].list = list;
    return is_new;
  }
  /// Removes it from its list: its slot can be reused.
  void remove_from_list(int slot) noexcept {
    tracking_[slot].list = none;
    --listed_;
  }

  [[nodiscard]] PairTracking& tracking(int slot) noexcept { return tracking_[slot]; }
  [[nodiscard]] const PairTracking& tracking(int slot) const noexcept { return tracking_[slot]; }
  [[nodiscard]] PairAnswer& answer(int slot) noexcept { return answers_[slot]; }
  [[nodiscard]] const PairAnswer& answer(int slot) const noexcept { return answers_[slot]; }
  [[nodiscard]] PairHistory& history(int slot) noexcept { return histories_[slot]; }
  [[nodiscard]] const PairHistory& history(int slot) const noexcept { return histories_[slot]; }
  [[nodiscard]] PairExtremes& extremes(PairId id) noexcept { return extremes_[index(id)]; }
  [[nodiscard]] const PairExtremes& extremes(PairId id) const noexcept {
    return extremes_[index(id)];
  }

 private:
  [[nodiscard]] static std::size_t index(PairId id) noexcept {
    return static_cast<std::size_t>(id.index);
  }

  [[nodiscard]] int free_slot() noexcept {
    for (int tried = 0; listed_ < slots_ && tried < slots_; ++tried) {
      const int slot = next_tried_;
      next_tried_ = next_tried_ + 1 < slots_ ? next_tried_ + 1 : 0;
      if (tracking_[slot].list == none) return slot;
    }
    return slots_;
  }

  void assign(int slot, PairId id) noexcept {
    PairTracking& tracking = tracking_[slot];
    if (!is_temporary(slot)) {
      if (tracking.pair.valid()) slot_of_[index(tracking.pair)] = none;
      slot_of_[index(id)] = slot;
    }
    const Pair& pair = world_->pair(id);
    tracking = {};
    tracking.body_a = world_->part(pair.a).body;
    tracking.body_b = world_->part(pair.b).body;
    tracking.reach = pair.law.reach() + lookahead_;
    tracking.pair = id;
    tracking.is_loose = world_->part(pair.a).room > 0.0 || world_->part(pair.b).room > 0.0;
    answers_[slot] = {};
    histories_[slot] = {};
  }

  const World* world_;
  double lookahead_;                    ///< [m]
  std::vector<std::int32_t> slot_of_;   ///< by PairId
  std::vector<PairExtremes> extremes_;  ///< by PairId
  int slots_;
  std::vector<PairTracking> tracking_;  ///< by slot, as the next two
  std::vector<PairAnswer> answers_;
  std::vector<PairHistory> histories_;
  int listed_ = 0;      ///< slots whose pairs are on a list
  int next_tried_ = 0;  ///< the slot that is tried next for a new pair
};

}  // namespace repel::detail
