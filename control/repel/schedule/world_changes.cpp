// SPDX-License-Identifier: BSD-3-Clause
#include <repel/schedule/world_changes.hpp>

#include <algorithm>
#include <cstddef>
#include <utility>

#include <repel/reduction/separation.hpp>
#include <repel/reduction/shape.hpp>

namespace repel {

WorldChanges::WorldChanges(const World& world, std::size_t capacity, int levels)
    : world_(&world), levels_(levels), ring_(capacity, Change{}) {
  for (const detail::LoosePart& loose : world.loose()) {
    const bool keeps_shape = loose.room <= world.part(loose.part).shape.reach();
    parts_.push_back({loose.part, loose.room, keeps_shape, world.is_there(loose.part)});
    since_.push_back(0);
  }
}

PartId WorldChanges::add(const Shape& shape, const Pose& X_WP, double over,
                         const ReservedShare& share) {
  if (!is_pose(X_WP) || !is_time(over)) return {};
  Reserved* chosen = nullptr;
  const std::size_t begin = std::min(share.first, parts_.size());
  const std::size_t end = begin + std::min(share.count, parts_.size() - begin);
  for (std::size_t i = begin; i < end; ++i) {
    Reserved& part = parts_[i];
    if (part.keeps_shape || part.is_used || !(shape.reach() <= part.room)) continue;
    if (chosen == nullptr || part.freed_at < chosen->freed_at) chosen = &part;
  }
  if (chosen == nullptr) return {};
  Change& change = ring_.draft();
  change = {.what = What::fit, .part = chosen->id, .X_WP = X_WP, .over = over, .shape = shape};
  if (needs_levels(shape, world_->query_options().measure)) {
    ReductionOptions reduction = shape.reduction();
    reduction.levels = levels_;
    change.shape = shape.reduced(reduction);
  }
  if (!ring_.post()) return {};
  chosen->is_used = true;
  return chosen->id;
}

bool WorldChanges::add(PartId id, const Pose& X_WP, double over) {
  Reserved* const part = find(id);
  if (part == nullptr || !is_pose(X_WP) || !is_time(over)) return false;
  if (!post({.what = What::add, .part = id, .X_WP = X_WP, .over = over})) return false;
  return part->is_used = true;
}

bool WorldChanges::move(PartId id, const Pose& X_WP, double speed) {
  return find(id) != nullptr && is_pose(X_WP) && detail::LooseParts::is_speed(speed) &&
         post({.what = What::move, .part = id, .X_WP = X_WP, .over = speed});
}

bool WorldChanges::attach(PartId id, BodyId tool, double over) {
  return find(id) != nullptr && is_time(over) &&
         post({.what = What::attach, .part = id, .tool = tool, .over = over});
}

bool WorldChanges::release(PartId id, double over) {
  return find(id) != nullptr && is_time(over) &&
         post({.what = What::release, .part = id, .over = over});
}

bool WorldChanges::remove(PartId id, double over) {
  Reserved* const part = find(id);
  if (part == nullptr || !is_time(over)) return false;
  if (!post({.what = What::remove, .part = id, .over = over})) return false;
  part->is_used = false;
  part->freed_at = ++freed_;
  return true;
}

void WorldChanges::apply(World& world, Coprocessor& coprocessor, int most) noexcept {
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    // The exchange to come is the first in which it is absent.
    if (world.is_there(world.loose()[i].part)) since_[i] = coprocessor.exchanges() + 1;
  }
  for (int k = 0; k < most; ++k) {
    Change* const change = ring_.front();
    if (change == nullptr) return;
    if (must_wait(world, coprocessor, *change)) {
      ++counts_.waited;
      return;
    }
    (make(world, *change) ? counts_.applied : counts_.refused) += 1;
    ring_.pop();
  }
}

bool WorldChanges::is_time(double over) noexcept {
  return detail::LooseParts::is_time(over);
}

bool WorldChanges::is_pose(const Pose& X) noexcept {
  return is_a_place(X, 1e-6);
}

WorldChanges::Reserved* WorldChanges::find(PartId id) noexcept {
  const auto found = std::find_if(parts_.begin(), parts_.end(),
                                  [&](const Reserved& part) { return part.id == id; });
  return found == parts_.end() ? nullptr : &*found;
}

bool WorldChanges::post(Change&& change) {
  ring_.draft() = std::move(change);
  return ring_.post();
}

bool WorldChanges::must_wait(World& world, Coprocessor& coprocessor,
                             const Change& change) const noexcept {
  if (change.what != What::fit && change.what != What::add) return false;
  const bool is_leaving = world.is_leaving(change.part);
  if (change.what == What::add || is_leaving) return is_leaving;
  if (world.is_there(change.part)) return false;  // and stays: the change is refused
  for (std::size_t i = 0; i < since_.size(); ++i) {
    if (world.loose()[i].part == change.part) return !coprocessor.is_past(since_[i]);
  }
  return false;
}

bool WorldChanges::make(World& world, Change& change) noexcept {
  switch (change.what) {
    case What::fit:
      return world.refit(change.part, change.shape) &&
             world.add(change.part, change.X_WP, change.over);
    case What::add:
      return world.add(change.part, change.X_WP, change.over);
    case What::move:
      return world.move(change.part, change.X_WP, change.over);
    case What::attach:
      return world.attach(change.part, change.tool, change.over);
    case What::release:
      return world.release(change.part, change.over);
    case What::remove:
      break;
  }
  return world.remove(change.part, change.over);
}

}  // namespace repel
