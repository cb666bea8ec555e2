// SPDX-License-Identifier: BSD-3-Clause
#include <repel/loop/tap.hpp>

#include <algorithm>
#include <chrono>
#include <span>

namespace repel {

std::span<const NearPair> Snapshot::near() const noexcept {
  return {pairs.data(), static_cast<std::size_t>(pair_count)};
}

Tap::Tap(const World& world, const TapOptions& options)
    : world_(&world),
      period_(options.picture_period),
      pictures_(room_for(world, options)),
      samples_(options.samples, {}),
      has_log_(options.log > 0),
      log_(std::max<std::size_t>(1, options.log), room_for(world, options)) {}

void Tap::note(const Coprocessor& coprocessor, std::span<const TickRecord* const> arms,
               const TickTimes& times) noexcept {
  const TickRecord& first = *arms.front();
  Status status = 0;
  for (const TickRecord* arm : arms) status |= arm->status;
  samples_.draft() = {first.tick, first.pairs.nearest, first.virtual_force.force.norm(), times,
                      status};
  (void)samples_.post();
  if (has_log_) {
    fill(log_.draft(), coprocessor, arms, times);
    (void)log_.post();
  }
  if (std::chrono::steady_clock::now() >= next_picture_) show(coprocessor, arms, times);
}

void Tap::show(const Coprocessor& coprocessor, std::span<const TickRecord* const> arms,
               const TickTimes& times) noexcept {
  next_picture_ = std::chrono::steady_clock::now() + period_;
  fill(pictures_.draft(), coprocessor, arms, times);
  pictures_.post();
}

Snapshot Tap::room_for(const World& world, const TapOptions& options) {
  Snapshot room;
  room.arms.resize(static_cast<std::size_t>(checked("arms", options.arms, 1, 64, "")));
  room.pairs.resize(static_cast<std::size_t>(checked("pairs", options.pairs, 1, 100000, "")));
  room.X_WB.resize(static_cast<std::size_t>(world.body_count()), Pose::Identity());
  room.is_there.resize(room.X_WB.size(), 1);
  return room;
}

bool Tap::is_nearer(const NearPair& a, const NearPair& b) noexcept {
  return a.separation.distance < b.separation.distance;
}

void Tap::fill(Snapshot& s, const Coprocessor& coprocessor, std::span<const TickRecord* const> arms,
               const TickTimes& times) const noexcept {
  for (std::size_t i = 0; i < s.arms.size() && i < arms.size(); ++i) s.arms[i] = *arms[i];
  const Motion& motion = world_->motion();
  for (std::size_t i = 0; i < s.X_WB.size(); ++i) {
    const BodyState& body = motion.bodies[i];
    s.X_WB[i] = body.X_WB;
    s.is_there[i] = !body.is_loose || body.presence.is_there() ? 1 : 0;
  }
  s.times = times;
  s.made = std::chrono::steady_clock::now();
  s.pair_count = s.pairs_omitted = 0;
  // A heap with the farthest pair on top, which a nearer one replaces.
  const auto begin = s.pairs.begin();
  coprocessor.for_each_near([&](const NearPair& near) {
    if (near.is_watched) return;
    if (s.pair_count < static_cast<int>(s.pairs.size())) {
      s.pairs[static_cast<std::size_t>(s.pair_count++)] = near;
    } else {
      ++s.pairs_omitted;
      if (!is_nearer(near, s.pairs.front())) return;
      std::pop_heap(begin, begin + s.pair_count, is_nearer);
      s.pairs[static_cast<std::size_t>(s.pair_count - 1)] = near;
    }
    std::push_heap(begin, begin + s.pair_count, is_nearer);
  });
  std::sort_heap(begin, begin + s.pair_count, is_nearer);
}

}  // namespace repel
