// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstddef>

#include "brute_force.hpp"
#include "method.hpp"
#include "pair_force.hpp"

namespace repel::scale {

namespace {

/// The pairs within range are known, tick by tick, from brute force in set-up.
class Known final : public Method {
 public:
  explicit Known(const Scene& scene)
      : parts_(scene.parts()),
        tool_parts_(scene.tool_parts()),
        obstacles_(scene.obstacles()),
        warm_(scene.setting().pairs),
        bodies_(scene.setting().bodies + 1),
        on_body_(bodies_.size()) {
    for (const Placement& p : scene.placements(0)) bodies_[p.body.index] = p;
    for (std::int32_t pair = 0; pair < scene.setting().pairs; ++pair) {
      laws_.push_back(World::effective(scene.law(), parts_[pair / obstacles_].shape,
                                       parts_[tool_parts_ + pair % obstacles_].shape));
    }
    BruteForce brute(scene);
    for (int tick = 0; tick < scene.setting().ticks; ++tick) {
      brute.tick(scene.placements(tick));
      within_.insert(within_.end(), brute.within().begin(), brute.within().end());
      end_.push_back(within_.size());
    }
  }

  void tick(std::int64_t tick, std::span<const Placement> placements) noexcept override {
    std::fill(on_body_.begin(), on_body_.end(), Wrench{});
    for (const Placement& p : placements) bodies_[p.body.index] = p;
    const auto at = static_cast<std::size_t>(tick);
    const std::size_t first = at == 0 ? 0 : end_[at - 1];
    evaluated_ = static_cast<int>(end_[at] - first);
    for (std::size_t i = first; i < end_[at]; ++i) evaluate(within_[i]);
  }
  void note(Record& record) const override {
    record.on_body.insert(record.on_body.end(), on_body_.begin(), on_body_.end());
  }
  [[nodiscard]] int evaluated() const override { return evaluated_; }

 private:
  void evaluate(std::int32_t pair) noexcept {
    const Part& a = parts_[pair / obstacles_];
    const Part& b = parts_[tool_parts_ + pair % obstacles_];
    const Placement& of_a = bodies_[a.body.index];
    const Placement& of_b = bodies_[b.body.index];
    const Pose X_WA = of_a.X_WB * a.X_BP;
    const Pose X_WB = of_b.X_WB * b.X_BP;
    const Separation s = separation(a.shape, X_WA, b.shape, X_WB, {}, warm_[pair]);
    push(s, {a.shape, X_WA, of_a.X_WB, of_a.V_WB}, {b.shape, X_WB, of_b.X_WB, of_b.V_WB},
         laws_[pair], on_body_[a.body.index], on_body_[b.body.index]);
  }

  std::vector<Part> parts_;
  int tool_parts_;
  int obstacles_;
  std::vector<WarmStart> warm_;  ///< by pair
  std::vector<Placement> bodies_;
  std::vector<Wrench> on_body_;
  std::vector<ForceLaw> laws_;        ///< by pair
  std::vector<std::int32_t> within_;  ///< the pairs within range, tick after tick
  std::vector<std::size_t> end_;      ///< of each tick in `within_`
  int evaluated_ = 0;
};

}  // namespace

Way known_pairs() {
  return {.name = "pairs known, with forces",
          .settings =
              "no broad phase: the pairs within range are told; query, patch and force "
              "of each",
          .load = [](const Scene& scene) { return std::make_unique<Known>(scene); }};
}

}  // namespace repel::scale
