/// @file
/// The pairs of a tick, several at a time.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>

#include <repel/distance/feature_lanes.hpp>
#include <repel/reduction/separation.hpp>

namespace repel {

/// What a call of `separation` would take, and where its answer goes. All are kept by the caller.
struct SeparationQuery {
  const Shape* A = nullptr;
  const Pose* X_WA = nullptr;  ///< pose of A in the world [m]
  const Shape* B = nullptr;
  const Pose* X_WB = nullptr;
  WarmStart* warm = nullptr;
  Separation* answer = nullptr;
};

namespace detail {

/// The queries whose last features are looked at together.
class SeparationLanes {
 public:
  explicit SeparationLanes(const QueryOptions& options) noexcept : options_(options) {}

  /// True for a query that has its place here, as long as `options` make sense.
  [[nodiscard]] static bool takes(const SeparationQuery& query) noexcept {
    return lane_count >= 4 && has_feature(*query.warm) &&
           are_angular(query.A->level(0), query.B->level(0));
  }
  [[nodiscard]] bool full() const noexcept { return count_ == pairs_.size(); }
  /// To be answered at the next `finish`; not when it is full.
  void add(const SeparationQuery& query) noexcept {
    const Level& a = query.A->level(0);
    const Level& b = query.B->level(0);
    pairs_[count_] = {&a.core,    query.X_WA, &b.core,
                      query.X_WB, query.warm, options_.ignore_beyond + a.depth + b.depth};
    queries_[count_] = query;
    ++count_;
  }

  /// Answers what was added since.
  [[gnu::noinline, gnu::flatten]] void finish() noexcept {
    if (count_ == 0) return;
    std::fill(pairs_.begin() + static_cast<std::ptrdiff_t>(count_), pairs_.end(), pairs_[0]);
    std::fill(queries_.begin() + static_cast<std::ptrdiff_t>(count_), queries_.end(), queries_[0]);
    const LaneGap gap = FeatureLanes(pairs_).prove(options_);
    const Lanes depth_a = lanes_of([&](int k) { return at(k).A->level(0).depth; });
    const Lanes depth_b = lanes_of([&](int k) { return at(k).B->level(0).depth; });
    const Lanes depth = depth_a + depth_b;
    const Lanes lower = gap.lower - depth;
    const Lanes upper = gap.upper - depth;
    const Lanes outward = Lanes{} + 0x1p-51;
    const Lanes distance = gap.distance - depth;
    const Lanes lower_widened = lower - outward * magnitudes(lower);
    const Lanes upper_widened = upper + outward * magnitudes(upper);
    const auto at_a = (gap.p_WA + gap.p_AQa_W - depth_a * gap.n_BA_W).each();
    const auto at_b = (gap.p_WA + gap.p_AQb_W + depth_b * gap.n_BA_W).each();
    const auto n_BA_W = gap.n_BA_W.each();
    for (std::size_t i = 0; i < count_; ++i) {
      const int k = static_cast<int>(i);
      const SeparationQuery& query = queries_[i];
      Separation& s = *query.answer;
      if ((gap.proven >> i & 1U) == 0U) {
        s = searched(*query.A, *query.X_WA, *query.B, *query.X_WB, options_, *query.warm);
        continue;
      }
      s.distance = distance[k];
      s.lower = lower_widened[k];
      s.upper = upper_widened[k];
      s.p_WA = to_vec3(at_a[i]);
      s.p_WB = to_vec3(at_b[i]);
      s.extraction_W = to_vec3(n_BA_W[i]);
      s.level = 0;
      s.iterations = 1;
      s.end = (gap.far >> i & 1U) != 0U ? QueryEnd::far_apart : QueryEnd::converged;
    }
    count_ = 0;
  }

 private:
  [[nodiscard]] const SeparationQuery& at(int k) const noexcept {
    return queries_[static_cast<std::size_t>(k)];
  }

  const QueryOptions& options_;
  std::size_t count_ = 0;
  std::array<LanePair, lane_count> pairs_;
  std::array<SeparationQuery, lane_count> queries_;
};

}  // namespace detail

/// Answers each of the queries: as `separation` does to within the brackets, and with the same
/// proof. Where a register of the target holds four doubles or more, pairs of boxes and hulls whose
/// nearest feature is still the one in their WarmStart are answered as many at a time; all others
/// one by one. An answer does not depend on what else is asked.
///
/// Cost: a pair in lanes of four doubles about 0.7 of a warm call of `separation`. No heap, no
/// lock, bounded by `options.iterations`.
inline void separations(std::span<const SeparationQuery> queries,
                        const QueryOptions& options = {}) noexcept {
  const bool usable = detail::are_usable(options);
  detail::SeparationLanes lanes(options);
  for (const SeparationQuery& q : queries) {
    if (usable && detail::SeparationLanes::takes(q)) {
      lanes.add(q);
      if (lanes.full()) lanes.finish();
    } else {
      *q.answer = separation(*q.A, *q.X_WA, *q.B, *q.X_WB, options, *q.warm);
    }
  }
  lanes.finish();
}

}  // namespace repel
