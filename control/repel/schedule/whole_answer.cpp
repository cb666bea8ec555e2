// SPDX-License-Identifier: BSD-3-Clause
#include <repel/schedule/whole_answer.hpp>

#include <algorithm>
#include <cstdint>
#include <span>

#include <repel/pairs/pair_geometry.hpp>

namespace repel::detail {

WholeAnswer::WholeAnswer(const World& world, int most) : near(most), shown(most) {
  motion.bodies.resize(static_cast<std::size_t>(world.body_count()));
}

void WholeAnswer::fill(const AnyPairSet& pairs, const Motion& at,
                       std::int64_t exchange_of_it) noexcept {
  exchange = exchange_of_it;
  motion.take(at);
  totals = pairs.forces().totals;
  count = 0;
  pairs.for_each_answer(at, [&](const NearPair& pair, const NearAnswer& answer) {
    near[count] = answer;
    shown[count] = pair;
    ++count;
  });
}

WidenedForces::WidenedForces(const World& world, int most)
    : world_(&world), since_(world.motion().bodies.size()), sizes_(most) {
  forces_ = PairForces(world.body_count());
}

void WidenedForces::widen(const WholeAnswer& answer, const Motion& now) noexcept {
  forces_.clear();
  forces_.tick = now.tick;
  forces_.totals = answer.totals;
  forces_.totals.peak_force = 0.0;
  forces_.totals.hardest_pair = {};
  for (std::size_t i = 0; i < since_.size(); ++i) {
    since_[i] = MotionSince::between(answer.motion.bodies[i], now.bodies[i]);
  }
  const std::span<const NearAnswer> all = answer.all();
  for (std::size_t i = 0; i < all.size();) i = add_run(all, i, now);
}

std::size_t WidenedForces::add_run(std::span<const NearAnswer> all, std::size_t first,
                                   const Motion& now) noexcept {
  const BodyId a = all[first].a;
  const BodyId b = all[first].b;
  const BodyState& A = now.bodies[static_cast<std::size_t>(a.index)];
  const BodyState& B = now.bodies[static_cast<std::size_t>(b.index)];
  const auto relative = relative_motion(A, B);
  const Share acts = share_between(A, B);
  Wrench on_a;
  std::size_t i = first;
  for (; i < all.size() && all[i].a == a && all[i].b == b; ++i) {
    sizes_[i] = 0.0;
    if (!acts.acts()) continue;  // gone since
    sizes_[i] = size_of(all[i], relative, acts.now);
    if (acts.now != acts.before) supply(all[i], acts.now - acts.before, now);
    forces_.totals.note_force(sizes_[i], all[i].pair);
    if (all[i].is_passable) {
      on_a += all[i].gradient;
    } else if (sizes_[i] > 0.0) {
      on_a += sizes_[i] * all[i].gradient;
    }
  }
  const Vec3 p_BA_W = to_vec3(relative.p_BA_W);
  forces_.push(a, b, on_a, {-on_a.force, -on_a.torque - p_BA_W.cross(on_a.force)}, now);
  return i;
}

double WidenedForces::size_of(const NearAnswer& answer,
                              const RelativeMotion<double, Vec<double>>& relative,
                              double acts) const noexcept {
  // What the spring of a passable body remembers is the workers': its force is theirs.
  if (answer.is_passable) return norm(answer.gradient.force);
  const Pair& pair = world_->pair(answer.pair);
  const double distance = distance_of(answer, pair);
  if (!(distance < pair.law.range)) return 0.0;
  const Wrench& g = answer.gradient;
  return acts * answer.share *
         force_of(pair.law.formula(), distance, Vec<double>(g.force), Vec<double>(g.torque),
                  relative);
}

void WidenedForces::supply(const NearAnswer& answer, double gained, const Motion& now) noexcept {
  const Pair& pair = world_->pair(answer.pair);
  if (answer.is_passable) return;
  const double potential = pair.law.potential(distance_of(answer, pair));
  forces_.supply(answer.a, answer.b, gained * answer.share * potential, now);
}

double WidenedForces::distance_of(const NearAnswer& answer, const Pair& pair) const noexcept {
  const double distance = bound_after(answer, since(answer.a), since(answer.b));
  return distance < 0.0 ? std::max(distance, -world_->deepest(pair)) : distance;
}

const MotionSince& WidenedForces::since(BodyId body) const noexcept {
  return since_[static_cast<std::size_t>(body.index)];
}

}  // namespace repel::detail
