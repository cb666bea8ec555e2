// SPDX-License-Identifier: BSD-3-Clause
// Observers do not change the run they observe.

#include <gtest/gtest.h>

#include <cstring>
#include <optional>
#include <thread>

#include <repel/runs/engine/run.hpp>
#include <repel/runs/operator/pace.hpp>

namespace repel::runs {
namespace run_test {

/// A scene with all that is needed to run it, and optionally a tap.
struct Bench {
  Bench(const std::string& name, const std::string& backend, bool has_tap, std::size_t log = 0)
      : scene(scene::load(std::string(REPEL_SOURCE "/scenes/") + name + ".yaml")) {
    options.fast = true;
    options.keep_records = true;
    options.seconds = 1.5;
    options.backend = backend;
    prepared = prepare(scene, options);
    TapOptions tap_options;
    tap_options.arms = static_cast<int>(prepared->cell.arms());
    tap_options.picture_period = std::chrono::nanoseconds(0);
    tap_options.samples = 64;
    tap_options.log = log;
    if (has_tap) tap.emplace(prepared->cell.world(), tap_options);
  }

  RunResult run(Controls* controls = nullptr) {
    const std::atomic<bool> stop{false};
    const Attachments attached{tap ? &*tap : nullptr, controls, nullptr, nullptr};
    prepared = prepare(scene, options);
    return runs::run(*prepared, attached, stop, [](const Progress&) {});
  }

  scene::Scene scene;
  RunOptions options;
  std::unique_ptr<PreparedRun> prepared;
  std::optional<Tap> tap;
};

template <class T>
bool same_bits(const T& a, const T& b) {
  return std::memcmp(a.data(), b.data(), sizeof *a.data() * static_cast<std::size_t>(a.size())) ==
         0;
}

/// All reproducible fields of a tick.
bool same(const TickRecord& a, const TickRecord& b) {
  const auto same_twist = [](const Twist& s, const Twist& t) {
    return same_bits(s.linear, t.linear) && same_bits(s.angular, t.angular);
  };
  const auto same_wrench = [](const Wrench& s, const Wrench& t) {
    return same_bits(s.force, t.force) && same_bits(s.torque, t.torque);
  };
  return a.tick == b.tick && a.time == b.time && a.phase == b.phase && a.status == b.status &&
         same_bits(a.q, b.q) && same_bits(a.v, b.v) &&
         same_twist(a.command.hand.ball, b.command.hand.ball) && same_bits(a.p_WT, b.p_WT) &&
         same_bits(a.v_WT, b.v_WT) && same_wrench(a.virtual_force, b.virtual_force) &&
         same_wrench(a.coupling, b.coupling) && a.lever_torque == b.lever_torque &&
         a.gain == b.gain && same_bits(a.torques, b.torques) && same_bits(a.energy, b.energy) &&
         a.pairs.near == b.pairs.near && a.pairs.evaluated == b.pairs.evaluated &&
         a.pairs.nearest == b.pairs.nearest && a.pairs.peak_force == b.pairs.peak_force;
}

void expect_same(const RunResult& a, const RunResult& b) {
  ASSERT_EQ(a.arms.size(), b.arms.size());
  for (std::size_t arm = 0; arm < a.arms.size(); ++arm) {
    const std::vector<TickRecord>& x = a.arms[arm].records;
    const std::vector<TickRecord>& y = b.arms[arm].records;
    ASSERT_EQ(x.size(), y.size());
    ASSERT_GT(x.size(), 500U);
    for (std::size_t k = 0; k < x.size(); ++k) ASSERT_TRUE(same(x[k], y[k])) << "tick " << k;
  }
}

/// Reads all three outlets of a tap as fast as it can.
class Reader {
 public:
  explicit Reader(Tap& tap)
      : thread_([this, &tap](const std::stop_token& stop) {
          for (bool last = false; !last;) {
            last = stop.stop_requested();
            pictures_ += tap.pictures().take() ? 1 : 0;
            for (; tap.samples().front() != nullptr; tap.samples().pop()) ++samples_;
            for (; tap.log().front() != nullptr; tap.log().pop()) {
              log_.push_back(tap.log().front()->arms);
            }
            std::this_thread::yield();
          }
        }) {}

  void stop() { thread_ = {}; }
  [[nodiscard]] int pictures() const { return pictures_; }
  [[nodiscard]] int samples() const { return samples_; }
  [[nodiscard]] const std::vector<std::vector<TickRecord>>& log() const { return log_; }

 private:
  int pictures_ = 0;
  int samples_ = 0;
  std::vector<std::vector<TickRecord>> log_;  ///< by tick, then by arm
  std::jthread thread_;
};

class RunOf : public testing::TestWithParam<std::string> {};
#ifdef REPEL_RUNS_BULLET
INSTANTIATE_TEST_SUITE_P(, RunOf, testing::Values("ideal", "bullet"));
#else
INSTANTIATE_TEST_SUITE_P(, RunOf, testing::Values("ideal"));
#endif

TEST_P(RunOf, LookingOnChangesNoBitOfIt) {
  for (const char* name : {"plates", "two_arms"}) {
    SCOPED_TRACE(name);
    const RunResult alone = Bench(name, GetParam(), false).run();
    Bench unread(name, GetParam(), true);
    expect_same(alone, unread.run());
    EXPECT_GT(unread.tap->samples().dropped(), 0) << "nobody read them";
    Bench read(name, GetParam(), true, 16);
    Reader reader(*read.tap);
    expect_same(alone, read.run());
    reader.stop();
    EXPECT_GT(reader.pictures(), 0);
    EXPECT_GT(reader.samples(), 0);
    ASSERT_EQ(read.tap->log().dropped(), 0);
    ASSERT_EQ(reader.log().size(), alone.arms.front().records.size());
    for (std::size_t k = 0; k < reader.log().size(); ++k) {
      for (std::size_t arm = 0; arm < alone.arms.size(); ++arm) {
        ASSERT_TRUE(same(reader.log()[k][arm], alone.arms[arm].records[k])) << "tick " << k;
      }
    }
  }
}

// There are controls, but no page takes control.
TEST_P(RunOf, ControlsThatNobodyTakesChangeNoBitOfIt) {
  const RunResult alone = Bench("plates", GetParam(), false).run();
  Controls controls;
  expect_same(alone, Bench("plates", GetParam(), true).run(&controls));
}

TEST_P(RunOf, APauseAndAStepChangeNoBitOfIt) {
  const RunResult alone = Bench("plates", GetParam(), false).run();
  Controls controls;
  controls.paused = true;
  controls.steps = 100;
  Bench bench("plates", GetParam(), true);
  const std::jthread someone([&] {
    while (controls.steps > 0) std::this_thread::yield();
    controls.steps += 7;
    while (controls.steps > 0) std::this_thread::yield();
    controls.paused = false;
  });
  expect_same(alone, bench.run(&controls));
}

TEST_P(RunOf, ARestartEndsItAndTheNextIsTheSame) {
  const RunResult alone = Bench("plates", GetParam(), false).run();
  Controls controls;
  Bench bench("plates", GetParam(), true);
  controls.paused = true;
  controls.steps = 50;
  const std::jthread someone([&] {
    while (controls.steps > 0) std::this_thread::yield();
    controls.restart = true;
  });
  const RunResult first = bench.run(&controls);
  EXPECT_TRUE(first.begins_anew);
  EXPECT_LT(first.arms.front().records.size(), 55U);
  controls.paused = false;
  controls.restart = false;
  const RunResult second = bench.run(&controls);
  EXPECT_FALSE(second.begins_anew);
  expect_same(alone, second);
}

}  // namespace run_test
}  // namespace repel::runs
