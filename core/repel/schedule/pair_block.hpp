/// @file
/// Up to 64 pairs that are worked through together: which are due, what is still known of the
/// others, and the forces of all of them.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <limits>
#include <vector>

#include <repel/force/passage.hpp>
#include <repel/reduction/separation.hpp>
#include <repel/world/world.hpp>

namespace repel {

/// How much a tick may cost.
struct Budget {
  std::int64_t work_units = 0;  ///< support-map pairs per tick, all blocks together; 0 = no limit.
                                ///< Each block finishes the pair it is at
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

/// The extremes of one pair since set-up.
struct PairExtremes {
  double nearest =
      std::numeric_limits<double>::infinity();  ///< [m] least signed distance evaluated
  double peak_force = 0.0;                      ///< [N]
};

namespace detail {

/// What decides whether a pair is near: kept apart from the rest, so that thousands of far pairs
/// fit into the cache.
struct PairWatch {
  BodyId body_a;
  BodyId body_b;
  double due_at = -std::numeric_limits<double>::infinity();  ///< [m] of travel of both bodies
};

/// What its force needs, also when it could not be evaluated again.
struct PairAnswer {
  double distance = -std::numeric_limits<double>::infinity();  ///< [m] signed, proven from below
  bool parted = false;         ///< a plane across extraction_W parts the shapes at that distance
  Vec3 extraction_W{0, 0, 0};  ///< unit
  double slope = 1.0;          ///< of the distance along it; asked of passable pairs only
  Vec3 p_AQ_W{0, 0, 0};        ///< [m] witness point on A, from the origin of body A
  Vec3 p_BA_W{0, 0, 0};        ///< [m] origin of body A from that of body B when it was evaluated
  double turn = 0.0;           ///< [m] both bodies' BodyState::turn then
  std::int64_t tick = 0;       ///< when it was evaluated
};

/// What its next evaluation begins with, and what users may ask for.
struct PairQuery {
  WarmStart warm;
  Separation last;
  PairExtremes extremes;
  Passage passage;
};

/// A slice of the world's pairs. All memory is taken at construction.
class PairBlock {
 public:
  static constexpr int capacity = 64;

  PairBlock(const World& world, int first, int count)
      : world_(&world), first_(first), watches_(count), answers_(count), queries_(count) {
    forces_.on_body.resize(world.body_count());
    for (int i = 0; i < count; ++i) {
      watches_[i].body_a = world.part(pair(i).a).body;
      watches_[i].body_b = world.part(pair(i).b).body;
    }
  }

  /// Works through the pairs until `work_units` are spent or `deadline` is reached, beginning where
  /// the last tick had to stop, so that no pair starves. The pair in hand is finished: half an
  /// answer would cost most of a whole one and might say less than the old one.
  /// @param X_WP pose of every part of the world, by PartId
  void run(const Motion& motion, const std::vector<Pose>& X_WP, std::int64_t work_units,
           std::chrono::steady_clock::time_point deadline) noexcept {
    if (forces_.totals.near > 0) forces_.clear();
    forces_.tick = motion.tick;
    const int count = this->count();
    const int begin = cursor_;
    bool spent = false;
    for (int k = 0; k < count; ++k) {
      const int i = begin + k < count ? begin + k : begin + k - count;
      if (!is_near(i, motion)) continue;
      const double least = widened(i, motion);
      if (least > pair(i).law.range) {
        watch_for(i, motion, least - pair(i).law.range);
        continue;
      }
      ++forces_.totals.near;
      const std::int64_t left = work_units - forces_.totals.iterations;
      if (!spent && is_spent(left, deadline)) {
        spent = true;
        cursor_ = i;
      }
      if (spent) {
        count_stale(motion.tick - answers_[i].tick);
        push(i, motion, least);
      } else {
        evaluate(i, motion, X_WP);
        push(i, motion, answers_[i].distance);
      }
    }
  }

  /// Asks up to `most` pairs again that were near at the last tick, and forgets the answers.
  /// Returns how many.
  int rehearse(const Motion& motion, const std::vector<Pose>& X_WP, int most) const noexcept {
    int asked = 0;
    for (int i = 0; i < count() && asked < most; ++i) {
      if (!is_near(i, motion)) continue;
      WarmStart warm = queries_[i].warm;
      const Pair& p = pair(i);
      (void)separation(world_->part(p.a).shape, X_WP[p.a.index], world_->part(p.b).shape,
                       X_WP[p.b.index], {}, warm);
      ++asked;
    }
    return asked;
  }

  [[nodiscard]] const PairForces& forces() const noexcept { return forces_; }
  [[nodiscard]] const Separation& separation_of(int i) const noexcept { return queries_[i].last; }
  [[nodiscard]] const PairExtremes& extremes_of(int i) const noexcept {
    return queries_[i].extremes;
  }
  [[nodiscard]] int first() const noexcept { return first_; }
  [[nodiscard]] int count() const noexcept { return static_cast<int>(watches_.size()); }

 private:
  using Clock = std::chrono::steady_clock;

  [[nodiscard]] static bool is_spent(std::int64_t units, Clock::time_point deadline) noexcept {
    if (units <= 0) return true;
    return deadline != Clock::time_point::max() && Clock::now() >= deadline;
  }

  [[nodiscard]] const Pair& pair(int i) const noexcept { return world_->pairs()[first_ + i]; }
  [[nodiscard]] const BodyState& body_a(int i, const Motion& motion) const noexcept {
    return motion.bodies[watches_[i].body_a.index];
  }
  [[nodiscard]] const BodyState& body_b(int i, const Motion& motion) const noexcept {
    return motion.bodies[watches_[i].body_b.index];
  }

  /// A pair whose bodies together have not travelled its clearance since it was evaluated cannot
  /// have come within range: it costs this comparison and nothing else. One that might by that
  /// count is looked at once more, along the direction that parts it (`widened`).
  [[nodiscard]] bool is_near(int i, const Motion& motion) const noexcept {
    return body_a(i, motion).travel + body_b(i, motion).travel >= watches_[i].due_at;
  }

  /// @param clearance [m] what the bodies may travel before the pair can be within range
  void watch_for(int i, const Motion& motion, double clearance) noexcept {
    watches_[i].due_at = clearance > 0.0
                             ? body_a(i, motion).travel + body_b(i, motion).travel + clearance
                             : -std::numeric_limits<double>::infinity();
  }

  void evaluate(int i, const Motion& motion, const std::vector<Pose>& X_WP) noexcept {
    const Pair& p = pair(i);
    const BodyState& A = body_a(i, motion);
    const BodyState& B = body_b(i, motion);
    const Shape& shape_a = world_->part(p.a).shape;
    const Shape& shape_b = world_->part(p.b).shape;
    const Pose& X_WPa = X_WP[p.a.index];
    const Pose& X_WPb = X_WP[p.b.index];
    Separation& s = queries_[i].last;
    s = separation(shape_a, X_WPa, shape_b, X_WPb, {}, queries_[i].warm);
    // A query that was cut short is answered by its proven bound, whose direction is not known.
    const bool cut_short = s.end == QueryEnd::budget_spent;
    const double slope = p.law.passable ? slope_of(s, shape_a, X_WPa, shape_b, X_WPb, {},
                                                   queries_[i].warm, s.iterations)
                                        : 1.0;
    answers_[i] = {cut_short || s.lower > 0.0 ? s.lower : s.distance,
                   s.lower > 0.0 && !cut_short,
                   s.extraction_W,
                   slope,
                   s.p_WA - A.X_WB.translation(),
                   A.X_WB.translation() - B.X_WB.translation(),
                   A.turn + B.turn,
                   motion.tick};
    watch_for(i, motion, s.lower - p.law.range);
    PairTotals& totals = forces_.totals;
    ++totals.evaluated;
    totals.iterations += s.iterations;
    queries_[i].extremes.nearest = std::min(queries_[i].extremes.nearest, s.distance);
    if (s.distance < totals.nearest) {
      totals.nearest = s.distance;
      totals.nearest_pair = {first_ + i};
    }
  }

  /// The least signed distance the pair can have now. While apart, the plane across the extraction
  /// direction still parts the shapes once it is moved by what they have moved along it; in overlap
  /// the distance falls no faster than the bodies move. Rotation takes at most `turn` either way.
  /// And no answer is ever deeper than both shapes' last levels.
  [[nodiscard]] double widened(int i, const Motion& motion) const noexcept {
    const PairAnswer& then = answers_[i];
    const BodyState& A = body_a(i, motion);
    const BodyState& B = body_b(i, motion);
    const Vec3 moved = A.X_WB.translation() - B.X_WB.translation() - then.p_BA_W;
    const double along = then.parted ? then.extraction_W.dot(moved) : -moved.norm();
    const double turned = A.turn + B.turn - then.turn;
    const double now = then.distance + along - turned;
    if (now > 0.0) return now;
    const Pair& p = pair(i);
    return std::max(now, -world_->part(p.a).shape.deepest() - world_->part(p.b).shape.deepest());
  }

  void count_stale(std::int64_t age) noexcept {
    ++forces_.totals.stale;
    forces_.totals.oldest_age = std::max(forces_.totals.oldest_age, age);
  }

  /// The force of the pair at that distance, on both bodies.
  void push(int i, const Motion& motion, double distance) noexcept {
    const ForceLaw& law = pair(i).law;
    if (!(distance < law.range)) return;
    const BodyState& A = body_a(i, motion);
    const BodyState& B = body_b(i, motion);
    const Vec3& n = answers_[i].extraction_W;
    const Vec3& p_AQ_W = answers_[i].p_AQ_W;
    const Vec3 p_BQ_W = p_AQ_W + A.X_WB.translation() - B.X_WB.translation();
    const Vec3 v_A = moved_to(A.V_WB, p_AQ_W).linear;
    const Vec3 v_B = moved_to(B.V_WB, p_BQ_W).linear;
    const Vec3 v_BA = v_A - v_B;
    double size = 0.0;
    Vec3 f;
    if (law.passable) {
      f = queries_[i].passage.force(law, distance, answers_[i].slope * n, A.travel + B.travel,
                                    v_BA);
      size = f.norm();
    } else {
      size = law(distance, n.dot(v_BA));
      f = size * n;
    }
    forces_.totals.peak_force = std::max(forces_.totals.peak_force, size);
    queries_[i].extremes.peak_force = std::max(queries_[i].extremes.peak_force, size);
    forces_.on_body[watches_[i].body_a.index] += wrench_of_force(f, p_AQ_W);
    forces_.on_body[watches_[i].body_b.index] += wrench_of_force(-f, p_BQ_W);
  }

  const World* world_;
  int first_ = 0;   ///< PairId of the first pair
  int cursor_ = 0;  ///< where the next tick begins
  std::vector<PairWatch> watches_;
  std::vector<PairAnswer> answers_;
  std::vector<PairQuery> queries_;
  PairForces forces_;
};

}  // namespace detail
}  // namespace repel
