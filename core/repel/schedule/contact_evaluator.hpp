/// @file
/// Evaluates the pairs of a block: those within range in lanes, all others one by one.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <optional>

#include <repel/schedule/contacts.hpp>
#include <repel/schedule/lane_wrench.hpp>
#include <repel/schedule/pair_evaluator.hpp>

namespace repel::detail {

/// A pair within range whose nearest feature is known is a contact. It has a seat in a group; what
/// it is answered stays there until it leaves, or until its answer is not of the present tick. All
/// memory is taken at construction.
class ContactEvaluator {
 public:
  /// @param slots for at most so many pairs, at least 0
  /// @param max_age [ticks] `Budget::max_age`
  ContactEvaluator(const World& world, PairShare share, int slots, std::int64_t max_age)
      : pairs_(world, share, slots, max_age), contacts_(pairs_.memory().slots()) {}

  /// The evaluator of single pairs, with the memory and the forces of all.
  [[nodiscard]] PairEvaluator& pairs() noexcept { return pairs_; }
  [[nodiscard]] const PairEvaluator& pairs() const noexcept { return pairs_; }
  [[nodiscard]] int count() const noexcept { return contacts_.count(); }
  [[nodiscard]] int groups() const noexcept { return contacts_.groups(); }

  /// Begins a tick: no force yet, and no answer is of it.
  void begin(std::int64_t tick) noexcept {
    pairs_.begin(tick);
    contacts_.grow_old();
  }

  /// The last answer that is remembered of a pair.
  [[nodiscard]] Separation separation_of(int slot) const noexcept {
    const int seat = memory().watch(slot).seat;
    if (seat < 0) return memory().answer(slot).last;
    const ContactGroup& group = contacts_.group(Contacts::group_of(seat));
    const int k = Contacts::lane_of(seat);
    return (group.proven() >> k & 1U) != 0U ? group.answer(k).last : memory().answer(slot).last;
  }
  [[nodiscard]] PairExtremes extremes_of(PairId id) const noexcept {
    PairExtremes extremes = memory().extremes(id);
    const int slot = memory().slot_of(id);
    const int seat = slot == PairMemory::none ? -1 : memory().watch(slot).seat;
    if (seat < 0) return extremes;
    const ContactGroup& group = contacts_.group(Contacts::group_of(seat));
    extremes.nearest = std::min(extremes.nearest, group.nearest(Contacts::lane_of(seat)));
    extremes.peak_force = std::max(extremes.peak_force, group.peak(Contacts::lane_of(seat)));
    return extremes;
  }
  /// The pair as the tick of `motion` has seen it, if it was near then. After `dismiss`.
  [[nodiscard]] std::optional<NearPair> near_pair(int slot, const Motion& motion) const noexcept {
    const int seat = memory().watch(slot).seat;
    if (seat < 0) return pairs_.near_pair(slot, motion);
    const ContactGroup& group = contacts_.group(Contacts::group_of(seat));
    const int k = Contacts::lane_of(seat);
    if ((group.proven() >> k & 1U) == 0U) return pairs_.near_pair(slot, motion);
    return NearPair{memory().watch(slot).pair, group.answer(k).last, group.force(k), false, 0};
  }

  /// Seats the pair among the contacts if it was answered at this tick and is one: within range,
  /// its nearest feature known.
  void seat(int slot, const PartPoses& poses) noexcept {
    if (pairs_.is_fresh(slot) && is_contact(slot)) {
      memory().watch(slot).seat =
          contacts_.add(slot, pairs_.world(), pairs_.pair(slot), memory().course(slot).warm, poses);
    }
  }

  /// Takes it away from there, if it is there.
  void unseat(int slot, const PartPoses& poses) noexcept {
    const int seat = memory().watch(slot).seat;
    if (seat < 0) return;
    const int last = contacts_.slot(contacts_.count() - 1);
    store(slot);
    store(last);
    memory().watch(last).seat = seat;
    memory().watch(slot).seat = -1;
    contacts_.replace_by_last(seat, pairs_.world(), pairs_.pair(last), memory().course(last).warm,
                              poses);
  }

  void unseat_all(const PartPoses& poses) noexcept {
    while (contacts_.count() > 0) unseat(contacts_.slot(contacts_.count() - 1), poses);
  }

  /// A group of contacts asked anew.
  void evaluate_group(int g, const Motion& motion, PartPoses& poses) noexcept {
    ContactGroup& group = contacts_.group(g);
    const unsigned stale = group.stale();
    for_each(stale, [&](int k) { pairs_.keep_claim(slot_at(g, k), motion); });
    group.evaluate(motion, poses);
    PairTotals& totals = pairs_.forces().totals;
    const int answered = std::popcount(group.proven());
    totals.evaluated += answered;
    totals.iterations += answered;
    const unsigned unproven = group.used() & ~group.proven();
    if ((stale | unproven) == 0U) return;
    for_each(stale & group.proven(), [&](int k) {
      pairs_.note_refresh(slot_at(g, k), group.answer(k).proven());
      memory().answer(slot_at(g, k)).is_stale = false;
    });
    for_each(unproven, [&](int k) {
      const int slot = slot_at(g, k);
      pairs_.evaluate(slot, motion, poses);
      if (is_contact(slot))
        group.renew(pairs_.world(), k, pairs_.pair(slot), memory().course(slot).warm);
    });
  }

  /// The forces of all contacts.
  void push_contacts(const Motion& motion) noexcept {
    GroupExtremes extremes;
    const int groups = contacts_.groups();
    all_stay_ = true;
    for (int g = 0; g < groups; ++g) {
      ContactGroup& group = contacts_.group(g);
      if (group.fresh()) {
        extremes.add(group);
        all_stay_ = all_stay_ && group.inside() == group.used();
        for_each(group.used() & ~group.proven(),
                 [&](int k) { pairs_.push(slot_at(g, k), motion); });
        continue;
      }
      for_each(group.used(), [&](int k) {
        store(slot_at(g, k));
        group.set_stale(k);
        pairs_.push(slot_at(g, k), motion);
      });
    }
    LaneWrench(motion, pairs_.forces()).add(contacts_.all());
    PairTotals& totals = pairs_.forces().totals;
    if (extremes.peak_force() > totals.peak_force) note_hardest(extremes.peak_force());
    if (extremes.nearest() < totals.nearest) note_nearest(extremes.nearest());
  }

  /// Unseats the contacts that have left their range, or whose nearest feature is no longer known,
  /// after `push_contacts`.
  void dismiss(const PartPoses& poses) noexcept {
    if (all_stay_) return;
    for (int g = contacts_.groups() - 1; g >= 0; --g) {
      const ContactGroup& group = contacts_.group(g);
      const unsigned staying = group.fresh() ? group.inside() : group.used();
      if ((group.used() & ~staying) == 0U) continue;
      for (int k = lane_count - 1; k >= 0; --k) {
        if ((group.used() & ~staying & 1U << k) == 0U) continue;
        const bool proven = (group.proven() >> k & 1U) != 0U;
        if (proven || !is_contact(slot_at(g, k))) unseat(slot_at(g, k), poses);
      }
    }
  }

  /// Does the last evaluation of the contacts again, which changes nothing. Returns how many.
  int rehearse(int most, const Motion& motion, PartPoses& poses) noexcept {
    int done = 0;
    for (int g = 0; g < contacts_.groups() && done < most; ++g) {
      ContactGroup& group = contacts_.group(g);
      if (!group.fresh() || group.proven() != group.used()) continue;
      group.evaluate(motion, poses);
      done += contacts_.taken(g);
    }
    return done;
  }

 private:
  [[nodiscard]] int slot_at(int g, int k) const noexcept {
    return contacts_.slot(g * lane_count + k);
  }
  [[nodiscard]] const PairWatch& watch_at(int g, int k) const noexcept {
    return memory().watch(slot_at(g, k));
  }
  /// f(k) for each bit that is set.
  template <class F>
  static void for_each(unsigned bits, const F& f) noexcept {
    for (; bits != 0U; bits &= bits - 1U) f(std::countr_zero(bits));
  }

  /// Some contact that was answered at this tick has that distance [m], the least of all.
  void note_nearest(double distance) noexcept {
    PairTotals& totals = pairs_.forces().totals;
    totals.nearest = distance;
    for (int g = 0; g < contacts_.groups(); ++g) {
      const ContactGroup& group = contacts_.group(g);
      if (!group.fresh()) continue;
      for_each(group.proven(), [&](int k) {
        if (group.distance(k) == distance) totals.nearest_pair = watch_at(g, k).pair;
      });
    }
  }

  /// Some contact that was answered at this tick pushes with that force [N], the largest of all.
  void note_hardest(double force) noexcept {
    for (int g = 0; g < contacts_.groups(); ++g) {
      const ContactGroup& group = contacts_.group(g);
      if (!group.fresh()) continue;
      for_each(group.used(), [&](int k) {
        if (group.force(k) == force) pairs_.forces().totals.note_force(force, watch_at(g, k).pair);
      });
    }
  }

  [[nodiscard]] bool is_contact(int slot) const noexcept {
    const PairMemory& memory = pairs_.memory();
    const Pair& p = pairs_.pair(slot);
    const World& world = pairs_.world();
    return memory.answer(slot).inside && !p.law.passable && !memory.is_lent(slot) &&
           has_feature(memory.course(slot).warm) &&
           are_angular(world.part(p.a).shape.level(0), world.part(p.b).shape.level(0));
  }

  /// Brings what its lane holds to the memory of the pair.
  void store(int slot) noexcept {
    const int seat = memory().watch(slot).seat;
    ContactGroup& group = contacts_.group(Contacts::group_of(seat));
    const int k = Contacts::lane_of(seat);
    PairExtremes& extremes = memory().extremes(memory().watch(slot).pair);
    extremes.add({.nearest = group.nearest(k), .peak_force = group.peak(k)});
    if ((group.proven() >> k & 1U) == 0U) return;
    pairs_.put(slot, group.answer(k));
    group.forget(k);
  }

  [[nodiscard]] PairMemory& memory() noexcept { return pairs_.memory(); }
  [[nodiscard]] const PairMemory& memory() const noexcept { return pairs_.memory(); }

  PairEvaluator pairs_;
  Contacts contacts_;
  bool all_stay_ = true;  ///< no contact has to be unseated after this tick
};

}  // namespace repel::detail
