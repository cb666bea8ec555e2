/// @file
/// The seats of the pairs that are evaluated in lanes.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include <repel/schedule/contact_lanes.hpp>

namespace repel::detail {

/// Groups of pairs without gaps: when one leaves, the last takes its seat. All memory is taken at
/// construction.
class Contacts {
 public:
  explicit Contacts(int most)
      : slots_(most + lane_count), groups_((most + lane_count - 1) / lane_count) {}

  /// Begins a tick: no answer is of it.
  void grow_old() noexcept {
    for (int g = 0; g < groups(); ++g) groups_[g].grow_old();
  }

  [[nodiscard]] int count() const noexcept { return count_; }
  [[nodiscard]] int groups() const noexcept { return (count_ + lane_count - 1) / lane_count; }
  [[nodiscard]] ContactGroup& group(int g) noexcept { return groups_[g]; }
  [[nodiscard]] const ContactGroup& group(int g) const noexcept { return groups_[g]; }
  [[nodiscard]] std::span<const ContactGroup> all() const noexcept {
    return {groups_.data(), static_cast<std::size_t>(groups())};
  }
  /// How many seats of a group are taken.
  [[nodiscard]] int taken(int g) const noexcept {
    return std::min(lane_count, count_ - g * lane_count);
  }
  [[nodiscard]] static int group_of(int seat) noexcept { return seat / lane_count; }
  [[nodiscard]] static int lane_of(int seat) noexcept { return seat % lane_count; }
  /// The slot of the pair on a seat.
  [[nodiscard]] std::int32_t slot(int seat) const noexcept { return slots_[seat]; }

  /// Seats a pair; returns the seat.
  int add(std::int32_t slot, const World& world, const Pair& pair, const WarmStart& warm,
          const PartPoses& poses) noexcept {
    slots_[count_] = slot;
    fill(count_, world, pair, warm, poses);
    return count_++;
  }
  /// Gives a seat to the pair of the last one, which need not be another.
  void replace_by_last(int seat, const World& world, const Pair& pair, const WarmStart& warm,
                       const PartPoses& poses) noexcept {
    --count_;
    slots_[seat] = slots_[count_];
    groups_[group_of(count_)].leave(lane_of(count_));
    if (seat < count_) groups_[group_of(seat)].set(world, lane_of(seat), pair, warm, poses, true);
  }

 private:
  /// The lanes behind the seat that nobody has are given some content, too.
  void fill(int seat, const World& world, const Pair& pair, const WarmStart& warm,
            const PartPoses& poses) noexcept {
    ContactGroup& group = groups_[group_of(seat)];
    for (int k = lane_of(seat); k < lane_count; ++k) {
      group.set(world, k, pair, warm, poses, k == lane_of(seat));
    }
  }

  int count_ = 0;
  std::vector<std::int32_t> slots_;  ///< by seat
  std::vector<ContactGroup> groups_;
};

}  // namespace repel::detail
