/// @file
/// One shape against many: the pairs of a tick, several at a time.
#pragma once

#include <array>
#include <span>

#include <repel/distance/feature_lanes.hpp>
#include <repel/reduction/separation.hpp>

namespace repel {

/// One of the others: what a call of `separation` would take, and where its answer goes.
struct Partner {
  const Shape* B = nullptr;
  const Pose* X_WB = nullptr;
  WarmStart* warm = nullptr;
  Separation* answer = nullptr;
};

namespace detail {

/// The partners whose last features are looked at together.
class PartnerLanes {
 public:
  PartnerLanes(const Shape& A, const Pose& X_WA, const QueryOptions& options) noexcept
      : A_(A), X_WA_(X_WA), lanes_X_WA_(LanePose::all(X_WA)), options_(options) {}

  void add(const Partner& partner) noexcept {
    const Level& level = partner.B->level(0);
    partners_[count_] = &partner;
    sets_[count_] = {&level.core, partner.X_WB, partner.warm,
                     options_.ignore_beyond + A_.level(0).depth + level.depth};
    if (++count_ == sets_.size()) finish();
  }
  /// Answers what was added since.
  [[gnu::noinline, gnu::flatten]] void finish() noexcept {
    if (count_ == 0) return;
    for (std::size_t k = count_; k < sets_.size(); ++k) sets_[k] = sets_[0];
    const Level& a = A_.level(0);
    const LaneGap gap = FeatureLanes(a.core, lanes_X_WA_, sets_).prove(options_);
    const Lanes depth_b = lanes_of([&](int k) {
      return partners_[std::min(static_cast<std::size_t>(k), count_ - 1)]->B->level(0).depth;
    });
    const Lanes depth = depth_b + a.depth;
    const Lanes lower = gap.lower - depth;
    const Lanes upper = gap.upper - depth;
    const Lanes outward = Lanes{} + 0x1p-51;
    const Lanes distance = gap.distance - depth;
    const Lanes lower_widened = lower - outward * magnitudes(lower);
    const Lanes upper_widened = upper + outward * magnitudes(upper);
    const LaneVec p_WA = lanes_X_WA_.columns[3];
    const auto at_a = (p_WA + gap.p_AQa_W - (Lanes{} + a.depth) * gap.n_BA_W).each();
    const auto at_b = (p_WA + gap.p_AQb_W + depth_b * gap.n_BA_W).each();
    const auto n_BA_W = gap.n_BA_W.each();
    for (std::size_t i = 0; i < count_; ++i) {
      const int k = static_cast<int>(i);
      const Partner& partner = *partners_[i];
      Separation& s = *partner.answer;
      if ((gap.proven >> i & 1U) == 0U) {
        s = searched(A_, X_WA_, *partner.B, *partner.X_WB, options_, *partner.warm);
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
  const Shape& A_;
  const Pose& X_WA_;
  LanePose lanes_X_WA_;
  const QueryOptions& options_;
  std::size_t count_ = 0;
  std::array<LaneSet, lane_count> sets_;
  std::array<const Partner*, lane_count> partners_;
};

}  // namespace detail

/// The separations of A from each of the partners: the answers of `separation` to within their
/// brackets, and the same proof. Where a register of the target holds four doubles or more, pairs
/// of boxes and hulls whose nearest feature is still the one in their WarmStart are answered as
/// many at a time; all others one by one.
///
/// @param X_WA pose of A in the world [m]
/// Cost: a pair in lanes of four doubles about 0.7 of a warm call of `separation`. No heap, no
/// lock, bounded by `options.iterations`.
inline void separations(const Shape& A, const Pose& X_WA, std::span<const Partner> partners,
                        const QueryOptions& options = {}) noexcept {
  const bool in_lanes =
      A.level(0).core.is_polytope() && detail::are_usable(options) && detail::lane_count >= 4;
  detail::PartnerLanes lanes(A, X_WA, options);
  for (const Partner& partner : partners) {
    if (in_lanes && detail::has_feature(*partner.warm) && partner.B->level(0).core.is_polytope()) {
      lanes.add(partner);
    } else {
      *partner.answer = separation(A, X_WA, *partner.B, *partner.X_WB, options, *partner.warm);
    }
  }
  lanes.finish();
}

}  // namespace repel
