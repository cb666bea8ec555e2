// SPDX-License-Identifier: BSD-3-Clause
#include <coal/narrowphase/narrowphase.h>
#include <coal/shape/convex.h>
#include <coal/config.hh>

#include "rival.hpp"

namespace repel::bench {

namespace {

class Coal {
 public:
  struct Result {
    double distance;
    coal::Vec3s p_WA, p_WB, n_AB_W;
  };

  Coal(const Task& task, double tolerance) : task_(task), guesses_(task.pairs.size()) {
    decide_inflation();
    for (const Solid& s : task.solids) shapes_.push_back(shape(s));
    for (const std::vector<Pose>& X_W : task.X_W) {
      auto& placed = X_W_.emplace_back();
      for (const Pose& X : X_W) placed.emplace_back(X.linear(), X.translation());
    }
    solver_.gjk_tolerance = tolerance;
    solver_.epa_tolerance = tolerance;
  }

  Result cold(const Ask& ask) {
    solver_.gjk_initial_guess = coal::GJKInitialGuess::BoundingVolumeGuess;
    solver_.support_func_cached_guess.setZero();
    return query(ask);
  }
  Result warm(const Ask& ask) {
    Guess& guess = guesses_[ask.pair];
    solver_.gjk_initial_guess = coal::GJKInitialGuess::CachedGuess;
    solver_.cached_guess = guess.ray;
    solver_.support_func_cached_guess = guess.hint;
    const Result result = query(ask);
    guess.ray = solver_.cached_guess;
    guess.hint = solver_.support_func_cached_guess;
    return result;
  }
  static Answer read(const Result& r) {
    return {.distance = r.distance, .extraction_W = -r.n_AB_W};
  }

 private:
  /// State of a pair kept from tick to tick.
  struct Guess {
    coal::Vec3s ray = coal::Vec3s(1, 0, 0);
    coal::support_func_guess_t hint = coal::support_func_guess_t::Zero();
  };

  /// Coal 3.0.3 decides once per process, by the direction of the first support query of any box,
  /// whether to inflate all boxes by 1e-10: an oblique first direction avoids that error.
  static void decide_inflation() {
    const coal::Box box(1.0, 1.0, 1.0);
    int hint = 0;
    (void)coal::details::getSupport(&box, coal::Vec3s(1.0, 2.0, 3.0), hint);
  }

  static std::shared_ptr<coal::ShapeBase> shape(const Solid& s) {
    std::shared_ptr<coal::ShapeBase> made;
    if (s.box) {
      made = std::make_shared<coal::Box>(Vec3(2.0 * s.half_extents));
    } else {
      auto points = std::make_shared<std::vector<coal::Vec3s>>(s.vertices);
      made.reset(coal::ConvexBase::convexHull(points, static_cast<unsigned>(points->size()), true));
    }
    made->computeLocalAABB();
    return made;
  }

  template <class A, class B>
  Result query(const coal::ShapeBase& a, const coal::Transform3s& X_WA, const coal::ShapeBase& b,
               const coal::Transform3s& X_WB) {
    Result r;
    r.distance = solver_.shapeDistance(static_cast<const A&>(a), X_WA, static_cast<const B&>(b),
                                       X_WB, true, r.p_WA, r.p_WB, r.n_AB_W);
    return r;
  }

  Result query(const Ask& ask) {
    const auto& [ia, ib] = task_.pairs[ask.pair];
    const coal::ShapeBase& a = *shapes_[ia];
    const coal::ShapeBase& b = *shapes_[ib];
    const auto& X_W = X_W_[ask.tick];
    const bool box_a = task_.solids[ia].box;
    const bool box_b = task_.solids[ib].box;
    if (box_a && box_b) return query<coal::Box, coal::Box>(a, X_W[ia], b, X_W[ib]);
    if (box_a) return query<coal::Box, coal::ConvexBase>(a, X_W[ia], b, X_W[ib]);
    if (box_b) return query<coal::ConvexBase, coal::Box>(a, X_W[ia], b, X_W[ib]);
    return query<coal::ConvexBase, coal::ConvexBase>(a, X_W[ia], b, X_W[ib]);
  }

  const Task& task_;
  coal::GJKSolver solver_;
  std::vector<std::shared_ptr<coal::ShapeBase>> shapes_;
  std::vector<std::vector<coal::Transform3s>> X_W_;
  std::vector<Guess> guesses_;
};

const Enlisted enlisted({
    .name = "coal",
    .version = COAL_VERSION,
    .settings = "GJKSolver::shapeDistance on Box and Convex with neighbours, without the dispatch "
                "of coal::distance; default GJK, faster here than Polyak and Nesterov; cold: "
                "BoundingVolumeGuess; warm: CachedGuess of ray and support; 1e-8 is as fast as "
                "the default 1e-6, and right more often",
    .tolerance = 1e-8,
    .load = Adapter<Coal>::load,
});

}  // namespace

}  // namespace repel::bench
