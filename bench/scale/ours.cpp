// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include <repel/schedule/coprocessor.hpp>

#include "method.hpp"

namespace repel::scale {

namespace {

class Ours final : public Method {
 public:
  Ours(const Scene& scene, const CoprocessorOptions& options)
      : world_(scene.world()), coprocessor_(world_, options) {}

  void tick(std::int64_t tick, std::span<const Placement> placements) noexcept override {
    world_.motion().tick = tick;
    for (const Placement& p : placements) world_.place(p.body, p.X_WB, p.V_WB);
    forces_ = &coprocessor_.exchange();
  }
  void settle() noexcept override { (void)coprocessor_.wait_for_answer(std::chrono::seconds(1)); }
  void note(Record& record) const override {
    if (coprocessor_.mode() == CoprocessorMode::together || coprocessor_.threads() == 0) {
      record.on_body.insert(record.on_body.end(), forces_->on_body.begin(), forces_->on_body.end());
      return;
    }
    const auto first = static_cast<std::ptrdiff_t>(record.within.size());
    coprocessor_.for_each_near(
        [&](const NearPair& near) { record.within.push_back(near.pair.index); });
    std::sort(record.within.begin() + first, record.within.end());
    record.end.push_back(record.within.size());
  }
  [[nodiscard]] int evaluated() const override { return forces_->totals.evaluated; }
  [[nodiscard]] WorkerReport workers() const override { return coprocessor_.workers(); }
  [[nodiscard]] WorkerUsage usage() const override { return coprocessor_.usage(); }

 private:
  World world_;
  Coprocessor coprocessor_;
  const PairForces* forces_ = nullptr;
};

Way way(const std::string& name, const CoprocessorOptions& options) {
  return {.name = name,
          .settings =
              "World::place and Coprocessor::exchange; beside, each tick begins when the "
              "threads have answered the last",
          .threads = options.threads,
          .mode = options.mode,
          .ours = true,
          .every_pair = options.every_pair,
          .load = [=](const Scene& scene) { return std::make_unique<Ours>(scene, options); }};
}

}  // namespace

Way ours(int threads, CoprocessorMode mode) {
  CoprocessorOptions options;
  options.threads = threads;
  options.mode = mode;
  options.period = std::chrono::nanoseconds(std::llround(1e9 * Scene::period));
  const bool beside = threads > 0 && mode == CoprocessorMode::beside;
  return way(beside ? "repel, beside" : "repel", options);
}

Way every_pair() {
  CoprocessorOptions options;
  options.every_pair = true;
  return way("repel, every pair", options);
}

}  // namespace repel::scale
