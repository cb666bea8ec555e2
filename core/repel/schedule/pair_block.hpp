/// @file
/// Up to 64 pairs that are worked through together: which are due, what is still known of the
/// others, and the forces of all of them.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <limits>
#include <vector>

#include <repel/reduction/separation.hpp>
#include <repel/world/world.hpp>

namespace repel {

/// How much a tick may cost.
struct Budget {
  std::int64_t work_units = 0;  ///< support-map pairs per tick, all blocks together; 0 = no limit
  std::chrono::nanoseconds wall{0};  ///< per tick and thread; 0 = no limit
};

/// What the pairs amount to in one tick, of a block or of the world.
struct PairTotals {
  int near = 0;                 ///< pairs that may be within range
  int evaluated = 0;            ///< of these, asked anew
  int stale = 0;                ///< of these, answered from an older tick, widened
  std::int64_t oldest_age = 0;  ///< [ticks] of the oldest answer that was used
  std::int64_t iterations = 0;  ///< support-map pairs spent
  double nearest =
      std::numeric_limits<double>::infinity();  ///< [m] least signed distance evaluated
  PairId nearest_pair;
  double peak_force = 0.0;  ///< [N] of one pair

  void add(const PairTotals& other) noexcept {
    near += other.near;
    evaluated += other.evaluated;
    stale += other.stale;
    oldest_age = std::max(oldest_age, other.oldest_age);
    iterations += other.iterations;
    if (other.nearest < nearest) {
      nearest = other.nearest;
      nearest_pair = other.nearest_pair;
    }
    peak_force = std::max(peak_force, other.peak_force);
  }
};

/// The forces of a set of pairs at one tick.
struct PairForces {
  std::int64_t tick = -1;       ///< of the motion they belong to
  std::vector<Wrench> on_body;  ///< [N, N m] by BodyId, about each body's origin, world axes
  PairTotals totals;

  void clear() noexcept {
    std::fill(on_body.begin(), on_body.end(), Wrench{});
    totals = {};
  }
};

namespace detail {

/// What is remembered of a pair between ticks.
struct PairState {
  Separation last;
  WarmStart warm;
  Vec3 p_AQ_W{0, 0, 0};  ///< [m] witness point on A, from the origin of body A
  Vec3 p_BA_W{0, 0, 0};  ///< [m] origin of body A from that of body B when it was evaluated
  double turn = 0.0;     ///< [m] both bodies' BodyState::turn then
  double due_at = -std::numeric_limits<double>::infinity();  ///< [m] of travel; see `is_near`
  std::int64_t tick = 0;                                     ///< when it was evaluated
};

/// A slice of the world's pairs. All memory is taken at construction.
class PairBlock {
 public:
  static constexpr int capacity = 64;

  PairBlock(const World& world, int first, int count)
      : world_(&world), first_(first), states_(count) {
    forces_.on_body.resize(world.body_count());
  }

  /// Works through the pairs with at most `work_units` and until `deadline`, beginning where the
  /// last tick had to stop, so that no pair starves.
  /// @param X_WP pose of every part of the world, by PartId
  void run(const Motion& motion, const std::vector<Pose>& X_WP, std::int64_t work_units,
           std::chrono::steady_clock::time_point deadline) noexcept {
    forces_.clear();
    forces_.tick = motion.tick;
    const int count = static_cast<int>(states_.size());
    const int begin = cursor_;
    bool spent = false;
    for (int k = 0; k < count; ++k) {
      const int i = begin + k < count ? begin + k : begin + k - count;
      if (!is_near(i, motion)) continue;
      PairTotals& totals = forces_.totals;
      ++totals.near;
      if (!spent && out_of(work_units - totals.iterations, deadline)) {
        spent = true;
        cursor_ = i;
      }
      const std::int64_t left = work_units - totals.iterations;
      if (!spent) evaluate(i, motion, X_WP, left);
      add_force(i, motion, spent);
    }
  }

  [[nodiscard]] const PairForces& forces() const noexcept { return forces_; }
  [[nodiscard]] const Separation& separation_of(int i) const noexcept { return states_[i].last; }
  [[nodiscard]] int first() const noexcept { return first_; }
  [[nodiscard]] int count() const noexcept { return static_cast<int>(states_.size()); }

 private:
  using Clock = std::chrono::steady_clock;

  [[nodiscard]] static bool out_of(std::int64_t units, Clock::time_point deadline) noexcept {
    if (units <= 0) return true;
    return deadline != Clock::time_point::max() && Clock::now() >= deadline;
  }

  [[nodiscard]] const Pair& pair(int i) const noexcept { return world_->pairs()[first_ + i]; }
  [[nodiscard]] const BodyState& body(PartId part, const Motion& motion) const noexcept {
    return motion.bodies[world_->part(part).body.index];
  }

  /// A pair whose bodies together have not travelled its clearance since it was evaluated cannot
  /// have come within range: it costs this comparison and nothing else.
  [[nodiscard]] bool is_near(int i, const Motion& motion) const noexcept {
    const Pair& p = pair(i);
    return body(p.a, motion).travel + body(p.b, motion).travel >= states_[i].due_at;
  }

  void evaluate(int i, const Motion& motion, const std::vector<Pose>& X_WP,
                std::int64_t units) noexcept {
    const Pair& p = pair(i);
    PairState& state = states_[i];
    const BodyState& A = body(p.a, motion);
    const BodyState& B = body(p.b, motion);
    QueryOptions options;
    options.iterations = static_cast<int>(std::min<std::int64_t>(options.iterations, units));
    state.last = separation(world_->part(p.a).shape, X_WP[p.a.index], world_->part(p.b).shape,
                            X_WP[p.b.index], options, state.warm);
    state.p_AQ_W = state.last.p_WA - A.X_WB.translation();
    state.p_BA_W = A.X_WB.translation() - B.X_WB.translation();
    state.turn = A.turn + B.turn;
    state.tick = motion.tick;
    const double clearance = state.last.lower - p.law.range;
    state.due_at = clearance > 0.0 ? A.travel + B.travel + clearance
                                   : -std::numeric_limits<double>::infinity();
    PairTotals& totals = forces_.totals;
    ++totals.evaluated;
    totals.iterations += state.last.iterations;
    if (state.last.distance < totals.nearest) {
      totals.nearest = state.last.distance;
      totals.nearest_pair = {first_ + i};
    }
  }

  /// The least signed distance the pair can have now. While apart, the plane across the extraction
  /// direction still parts the shapes once it is moved by what they have moved along it; in overlap
  /// the distance falls no faster than the bodies move. Rotation takes at most `turn` either way.
  [[nodiscard]] double widened(const PairState& state, const BodyState& A,
                               const BodyState& B) const noexcept {
    const Vec3 moved = A.X_WB.translation() - B.X_WB.translation() - state.p_BA_W;
    const double turned = A.turn + B.turn - state.turn;
    const bool open = state.last.end == QueryEnd::budget_spent;
    const double then = open ? state.last.lower : state.last.distance;
    const double along = then > 0.0 ? state.last.extraction_W.dot(moved) : -moved.norm();
    return then + along - turned;
  }

  void add_force(int i, const Motion& motion, bool stale) noexcept {
    const Pair& p = pair(i);
    const PairState& state = states_[i];
    const BodyState& A = body(p.a, motion);
    const BodyState& B = body(p.b, motion);
    PairTotals& totals = forces_.totals;
    if (stale) {
      ++totals.stale;
      totals.oldest_age = std::max(totals.oldest_age, motion.tick - state.tick);
    }
    const double distance = stale ? widened(state, A, B) : state.last.distance;
    if (!(distance < p.law.range)) return;
    const Vec3& n = state.last.extraction_W;
    const Vec3 p_BQ_W = state.p_AQ_W + A.X_WB.translation() - B.X_WB.translation();
    const Vec3 v_A = moved_to(A.V_WB, state.p_AQ_W).linear;
    const Vec3 v_B = moved_to(B.V_WB, p_BQ_W).linear;
    const double size = p.law(distance, n.dot(v_A - v_B));
    totals.peak_force = std::max(totals.peak_force, size);
    const Vec3 f = size * n;
    forces_.on_body[world_->part(p.a).body.index] += wrench_of_force(f, state.p_AQ_W);
    forces_.on_body[world_->part(p.b).body.index] += wrench_of_force(-f, p_BQ_W);
  }

  const World* world_;
  int first_ = 0;   ///< PairId of the first pair
  int cursor_ = 0;  ///< where the next tick begins
  std::vector<PairState> states_;
  PairForces forces_;
};

}  // namespace detail
}  // namespace repel
