// SPDX-License-Identifier: BSD-3-Clause
// Failing threads beside the loop: it continues without them.
#include <gtest/gtest.h>

#include <stdexcept>

#include <repel/runs/engine/run.hpp>
#include <repel/runs/records/log.hpp>

namespace repel::runs {
namespace threads_test {

/// Throws at a given tick, and from then on.
class FailingLog final : public TickLog {
 public:
  explicit FailingLog(std::int64_t at) : at_(at) {}
  void write(const Snapshot& tick) override {
    if (tick.arms.front().tick >= at_) throw std::runtime_error("no words for it");
    ++written;
  }
  void flush() override {}
  [[nodiscard]] std::string trouble() const override { return {}; }
  void close(std::int64_t dropped) override {
    lacking = dropped;
    throw std::runtime_error("nor for the end");
  }

  std::int64_t written = 0;
  std::int64_t lacking = -1;

 private:
  std::int64_t at_;
};

struct Stage {
  Stage() : scene(scene::load(REPEL_SOURCE "/scenes/empty.yaml")) {
    options.fast = true;
    options.seconds = 2.0;
    options.rate_hz = scene.rate_hz;
    options.backend = "ideal";
  }
  scene::Scene scene;
  RunOptions options;
  const std::atomic<bool> stop{false};
};

TEST(Threads, ALogThatThrowsEndsAndTheRunGoesOn) {
  Stage stage;
  const auto prepared = prepare(stage.scene, stage.options);
  TapOptions tap_options;
  tap_options.arms = static_cast<int>(prepared->cell.arms());
  tap_options.log = 64;
  Tap tap(prepared->cell.world(), tap_options);
  FailingLog log(10);
  std::string said;
  LogThread writing(tap.log(), log, [&](const std::string& trouble) { said += trouble; });
  const RunResult result =
      run(*prepared, {&tap, nullptr, nullptr, nullptr}, stage.stop, [](const Progress&) {});
  const std::int64_t lacking = writing.close();
  EXPECT_EQ(said, "no words for it");
  EXPECT_GT(log.written, 0);
  EXPECT_EQ(log.written + lacking, result.totals().ticks);
  EXPECT_EQ(log.lacking, lacking);
}

TEST(Threads, ProgressThatCannotBeShownDoesNotEndTheRun) {
  Stage stage;
  stage.options.fast = false;
  stage.options.seconds = 1.5;  // progress is shown every 0.2 s
  int shown = 0;
  testing::internal::CaptureStderr();
  const RunResult result =
      run(*prepare(stage.scene, stage.options), {}, stage.stop, [&](const Progress&) {
        ++shown;
        throw std::runtime_error("the terminal is gone");
      });
  const std::string said = testing::internal::GetCapturedStderr();
  EXPECT_EQ(said, "Progress is not shown any more, the run goes on: the terminal is gone\n");
  EXPECT_EQ(shown, 1);
  EXPECT_GT(result.totals().ticks, 0);
}

}  // namespace threads_test
}  // namespace repel::runs
