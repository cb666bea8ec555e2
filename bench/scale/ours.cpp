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
  void note(Record& record) const override {
    record.on_body.insert(record.on_body.end(), forces_->on_body.begin(), forces_->on_body.end());
  }
  [[nodiscard]] int evaluated() const override { return forces_->totals.evaluated; }

 private:
  World world_;
  Coprocessor coprocessor_;
  const PairForces* forces_ = nullptr;
};

Way way(const std::string& name, const CoprocessorOptions& options) {
  return {.name = name,
          .settings = "World::place and Coprocessor::exchange, in lock step where threads work",
          .threads = options.threads,
          .ours = true,
          .every_pair = options.every_pair,
          .load = [=](const Scene& scene) { return std::make_unique<Ours>(scene, options); }};
}

}  // namespace

Way ours(int threads) {
  CoprocessorOptions options;
  options.threads = threads;
  options.lock_step = true;
  return way("repel", options);
}

Way every_pair() {
  CoprocessorOptions options;
  options.every_pair = true;
  return way("repel, every pair", options);
}

}  // namespace repel::scale
