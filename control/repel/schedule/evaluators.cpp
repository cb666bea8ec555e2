// SPDX-License-Identifier: BSD-3-Clause
// Compiled once with the rest of this library, and again for each further instruction set: then
// with REPEL_EVALUATORS, the name of the only symbol that is left of it for the linker.
#include <repel/schedule/evaluators.hpp>

#include <algorithm>

#include <repel/pairs/pair_set.hpp>
#include <repel/reduction/separation.hpp>

#ifndef REPEL_EVALUATORS
#define REPEL_EVALUATORS repel_evaluators
#endif

namespace repel::detail {
namespace {

class PairSetHere final : public AnyPairSet {
 public:
  PairSetHere(const World& world, int slots, const Budget& budget, double lookahead)
      : pairs_(world, slots, budget, lookahead) {}

  void prime(const Motion& motion, PartPoses& poses) noexcept override {
    pairs_.prime(motion, poses);
  }
  void track_all(const PairIndex& index) noexcept override { pairs_.track_all(index); }
  void begin_tick(std::int64_t tick) noexcept override { pairs_.begin_tick(tick); }
  bool take(PairId id, std::int32_t list, double distance, const Motion& motion,
            PartPoses& poses) noexcept override {
    return pairs_.take(id, list, distance, motion, poses);
  }
  int end(std::int32_t list) noexcept override { return pairs_.end(list); }
  void drop(std::int32_t list) noexcept override { pairs_.drop(list); }
  int select(const Motion& motion, PartPoses& poses,
             const EvaluationLimit& limit) noexcept override {
    return pairs_.select(motion, poses, limit);
  }
  std::int64_t evaluate(int batch, const Motion& motion, PartPoses& poses) noexcept override {
    return pairs_.evaluate(batch, motion, poses);
  }
  void evaluate_all(const Motion& motion, PartPoses& poses) noexcept override {
    pairs_.evaluate_all(motion, poses);
  }
  void finish(const Motion& motion, const PartPoses& poses) noexcept override {
    pairs_.finish(motion, poses);
  }
  void skip_ticks() noexcept override { pairs_.skip_ticks(); }
  void forget(const PartPoses& poses) noexcept override { pairs_.forget(poses); }
  int rehearse(const Motion& motion, PartPoses& poses, int most) noexcept override {
    return pairs_.rehearse(motion, poses, most);
  }
  [[nodiscard]] int selected() const noexcept override { return pairs_.selected(); }
  [[nodiscard]] const PairForces& forces() const noexcept override { return pairs_.forces(); }
  [[nodiscard]] Separation separation_of(PairId id) const noexcept override {
    return pairs_.separation_of(id);
  }
  [[nodiscard]] PairExtremes extremes_of(PairId id) const noexcept override {
    return pairs_.extremes_of(id);
  }

 protected:
  void visit_near(const Motion& motion, SeeNear see, const void* of) const noexcept override {
    pairs_.for_each_near(motion, [&](const NearPair& near) { see(of, near); });
  }
  void visit_answers(const Motion& motion, SeeAnswer see, const void* of) const noexcept override {
    pairs_.for_each_answer(
        motion, [&](const NearPair& near, const NearAnswer& answer) { see(of, near, answer); });
  }

 private:
  PairSet pairs_;
};

std::unique_ptr<AnyPairSet> make_pair_set_here(const World& world, int slots, const Budget& budget,
                                               double lookahead) {
  return std::make_unique<PairSetHere>(world, slots, budget, lookahead);
}

void separations_here(std::span<const PosedShapes> pairs, const QueryOptions& options,
                      std::span<WarmStart> warm, std::span<Separation> results) noexcept {
  std::size_t count = std::min(pairs.size(), results.size());
  if (!warm.empty()) count = std::min(count, warm.size());
  for (std::size_t i = 0; i < count; ++i) {
    const auto& [a, b] = pairs[i];
    WarmStart cold;
    results[i] = separation(a.shape, a.X_W, b.shape, b.X_W, options, warm.empty() ? cold : warm[i]);
  }
}

constexpr const char* name_here =
#if defined(__AVX512F__)
    "x86-64-v4";
#elif defined(__AVX2__)
    "x86-64-v3";
#elif defined(__AVX__)
    "x86-64-v2 and AVX";
#elif defined(__x86_64__)
    "x86-64";
#elif defined(__aarch64__)
    "aarch64";
#else
    "of the compiler";
#endif

}  // namespace
}  // namespace repel::detail

extern "C" const repel::detail::Evaluators REPEL_EVALUATORS = {
    repel::detail::name_here, &repel::detail::make_pair_set_here, &repel::detail::separations_here};
