// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The pairs of a world, evaluated by code that was compiled for the instruction set chosen at the
/// start of the program.
#pragma once

#include <cstdint>
#include <memory>

#include <repel/pairs/budget.hpp>
#include <repel/pairs/evaluation_plan.hpp>
#include <repel/pairs/near_answer.hpp>
#include <repel/pairs/near_pair.hpp>
#include <repel/pairs/pair_index.hpp>
#include <repel/pairs/part_poses.hpp>

namespace repel::detail {

/// A PairSet: its functions are documented there (repel/pairs/pair_set.hpp).
class AnyPairSet {
 public:
  AnyPairSet() = default;
  AnyPairSet(const AnyPairSet&) = delete;
  AnyPairSet& operator=(const AnyPairSet&) = delete;
  virtual ~AnyPairSet() = default;

  virtual void prime(const Motion& motion, PartPoses& poses) noexcept = 0;
  virtual void track_all(const PairIndex& index) noexcept = 0;
  virtual void begin_tick(std::int64_t tick) noexcept = 0;
  virtual bool take(PairId id, std::int32_t list, double distance, const Motion& motion,
                    PartPoses& poses) noexcept = 0;
  virtual int end(std::int32_t list) noexcept = 0;
  virtual void drop(std::int32_t list) noexcept = 0;
  virtual int select(const Motion& motion, PartPoses& poses,
                     const EvaluationLimit& limit) noexcept = 0;
  virtual std::int64_t evaluate(int batch, const Motion& motion, PartPoses& poses) noexcept = 0;
  virtual void evaluate_all(const Motion& motion, PartPoses& poses) noexcept = 0;
  virtual void finish(const Motion& motion, const PartPoses& poses) noexcept = 0;
  virtual void skip_ticks() noexcept = 0;
  virtual void forget(const PartPoses& poses) noexcept = 0;
  virtual int rehearse(const Motion& motion, PartPoses& poses, int most) noexcept = 0;
  [[nodiscard]] virtual int selected() const noexcept = 0;
  [[nodiscard]] virtual const PairForces& forces() const noexcept = 0;
  [[nodiscard]] virtual Separation separation_of(PairId id) const noexcept = 0;
  [[nodiscard]] virtual PairExtremes extremes_of(PairId id) const noexcept = 0;

  template <class See>
  void for_each_near(const Motion& motion, const See& see) const noexcept {
    visit_near(
        motion,
        [](const void* of, const NearPair& near) noexcept { (*static_cast<const See*>(of))(near); },
        &see);
  }
  template <class See>
  void for_each_answer(const Motion& motion, const See& see) const noexcept {
    visit_answers(
        motion,
        [](const void* of, const NearPair& near, const NearAnswer& answer) noexcept {
          (*static_cast<const See*>(of))(near, answer);
        },
        &see);
  }

 protected:
  using SeeNear = void (*)(const void* of, const NearPair& near) noexcept;
  using SeeAnswer = void (*)(const void* of, const NearPair& near,
                             const NearAnswer& answer) noexcept;
  virtual void visit_near(const Motion& motion, SeeNear see, const void* of) const noexcept = 0;
  virtual void visit_answers(const Motion& motion, SeeAnswer see,
                             const void* of) const noexcept = 0;
};

/// The pairs of `world`, evaluated by the code for the instruction set in use. Allocates.
/// @throws SetupError as `instruction_set`
std::unique_ptr<AnyPairSet> make_pair_set(const World& world, int slots, const Budget& budget,
                                          double lookahead);

}  // namespace repel::detail
