// SPDX-License-Identifier: BSD-3-Clause

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include <repel/runs/operator/pace.hpp>

namespace repel::runs {
namespace pace_test {

using namespace std::chrono_literals;
constexpr double period = 0.0025;
constexpr auto tick_period = 2500us;

/// A loop of ticks in a thread of its own, like that of runs::run.
class Loop {
 public:
  explicit Loop(Pacing pacing, std::int64_t ticks = 1'000'000'000)
      : thread_([this, pacing, ticks] {
          Pace pace(pacing, tick_period, &controls);
          for (std::int64_t k = 0; k < ticks && !stop_; ++k) {
            const double time = period * static_cast<double>(k);
            if (pace.begins_anew(time)) break;
            (void)pace.wait(
                time, stop_, [] {}, [this] { shown_ = at_.load(); });
            lost_ = lost_ + pace.catch_up();
            at_ = k;
            made_ = made_ + 1;
          }
          shown_ = at_.load();
          if (pacing == Pacing::shown) pace.rest(stop_);
          anew_ = !stop_ && pace.begins_anew(period * static_cast<double>(ticks));
          over_ = true;
        }) {}
  Loop(const Loop&) = delete;
  Loop& operator=(const Loop&) = delete;
  ~Loop() { stop(); }

  void stop() {
    stop_ = true;
    if (thread_.joinable()) thread_.join();
  }

  [[nodiscard]] std::int64_t made() const { return made_; }    ///< number of ticks executed
  [[nodiscard]] std::int64_t lost() const { return lost_; }    ///< number of ticks skipped
  [[nodiscard]] std::int64_t at() const { return at_; }        ///< number of the last tick
  [[nodiscard]] std::int64_t shown() const { return shown_; }  ///< tick shown by a pause
  [[nodiscard]] bool over() const { return over_; }
  [[nodiscard]] bool anew() const { return anew_; }

  Controls controls;

 private:
  std::atomic<bool> stop_{false};
  std::atomic<bool> over_{false};
  std::atomic<bool> anew_{false};
  std::atomic<std::int64_t> made_{0};
  std::atomic<std::int64_t> lost_{0};
  std::atomic<std::int64_t> at_{-1};
  std::atomic<std::int64_t> shown_{-1};
  std::jthread thread_;
};

/// Only a timeout against hangs.
bool eventually(const std::function<bool()>& holds) {
  const auto until = std::chrono::steady_clock::now() + 60s;
  while (!holds()) {
    if (std::chrono::steady_clock::now() > until) return false;
    std::this_thread::sleep_for(1ms);
  }
  return true;
}

/// Number of ticks executed once the loop is paused.
std::int64_t still(const Loop& loop) {
  for (std::int64_t made = -1; made != loop.made();) {
    made = loop.made();
    std::this_thread::sleep_for(100ms);
  }
  return loop.made();
}

class PaceOfAny : public testing::TestWithParam<Pacing> {};
INSTANTIATE_TEST_SUITE_P(, PaceOfAny,
                         testing::Values(Pacing::by_the_clock, Pacing::at_once, Pacing::shown));

TEST_P(PaceOfAny, PausedItStandsAndStepsAreCounted) {
  Loop loop(GetParam());
  EXPECT_TRUE(eventually([&] { return loop.made() > 5; }));
  loop.controls.paused = true;
  std::int64_t made = still(loop);
  const std::int64_t lost = loop.lost();
  for (const std::int64_t steps : {1, 1, 7, 300}) {
    loop.controls.steps += steps;
    made += steps;
    EXPECT_TRUE(eventually([&] { return loop.made() >= made; }));
    EXPECT_EQ(still(loop), made);
    EXPECT_EQ(loop.shown(), loop.at()) << "the last of them is to be seen";
    EXPECT_EQ(loop.controls.steps, 0);
    EXPECT_EQ(loop.lost(), lost) << "none was missed in the pause";
  }
  loop.controls.paused = false;
  EXPECT_TRUE(eventually([&] { return loop.made() > made + 5; }));
  loop.controls.paused = true;
  made = still(loop);
  EXPECT_EQ(made, loop.at() + 1) << "none is left out";
}

TEST_P(PaceOfAny, ItCanEndAndBeginAnewWhilePaused) {
  for (const bool restart : {false, true}) {
    Loop loop(GetParam());
    loop.controls.paused = true;
    (void)still(loop);
    if (restart) {
      loop.controls.restart = true;
      EXPECT_TRUE(eventually([&] { return loop.over(); }));
      EXPECT_TRUE(loop.anew());
    }
    loop.stop();
    EXPECT_TRUE(loop.over());
  }
}

TEST(Pace, WithoutControlsNobodyHoldsItUp) {
  Pace pace(Pacing::at_once, tick_period, nullptr);
  const std::atomic<bool> stop{false};
  for (int k = 0; k < 1000; ++k) {
    EXPECT_FALSE(pace.begins_anew(period * k));
    EXPECT_EQ(pace.wait(period * k, stop, [] {}), 0ns);
    EXPECT_EQ(pace.catch_up(), 0);
  }
  pace.rest(stop);
}

// A seek runs at full speed up to the requested time, and in real time from there.
TEST(Pace, SeekForwardGoesThereAndIsSeen) {
  Loop loop(Pacing::shown);
  loop.controls.paused = true;
  (void)still(loop);
  loop.controls.seek = 100.0;
  EXPECT_TRUE(eventually([&] { return loop.shown() == 40000; }));
  EXPECT_TRUE(eventually([&] { return loop.controls.seek < 0.0; }));
  (void)still(loop);
  EXPECT_LT(loop.at(), 40002) << "it is paused there";
}

TEST(Pace, SeekBackBeginsAnew) {
  for (const bool paused : {false, true}) {
    Loop loop(Pacing::shown);
    loop.controls.seek = 100.0;
    EXPECT_TRUE(eventually([&] { return loop.at() >= 40000; }));
    loop.controls.paused = paused;
    if (paused) (void)still(loop);
    loop.controls.seek = 1.0;
    EXPECT_TRUE(eventually([&] { return loop.over(); })) << (paused ? "paused" : "running");
    EXPECT_TRUE(loop.anew());
    EXPECT_EQ(loop.controls.seek, 1.0) << "it is still to be gone to";
  }
}

TEST(Pace, AtItsEndARecordingWaits) {
  Loop loop(Pacing::shown, 100);
  EXPECT_TRUE(eventually([&] { return loop.made() == 100; }));
  (void)still(loop);
  EXPECT_FALSE(loop.over());
  loop.controls.seek = 0.1;
  EXPECT_TRUE(eventually([&] { return loop.over(); }));
  EXPECT_TRUE(loop.anew());
}

TEST(Pace, SeekToTheLastTickIsTheEnd) {
  Loop loop(Pacing::shown, 100000);
  loop.controls.seek = period * 99999;
  EXPECT_TRUE(eventually([&] { return loop.shown() == 99999; }));
  (void)still(loop);
  EXPECT_FALSE(loop.over());
  EXPECT_LT(loop.controls.seek, 0.0);
}

// A hundred times slower takes longer on any machine; and the speed can be changed during the run.
TEST(Pace, SpeedIsAgainstTheClock) {
  const auto begin = std::chrono::steady_clock::now();
  Loop loop(Pacing::shown);
  loop.controls.speed = 100.0;
  EXPECT_TRUE(eventually([&] { return loop.at() > 4000; }));
  loop.controls.speed = 0.01;
  const std::int64_t before = loop.made();
  std::this_thread::sleep_for(500ms);
  const double passed =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  EXPECT_LE(static_cast<double>(loop.made() - before), 3.0 + 100.0 * passed);
  loop.controls.speed = 100.0;
  EXPECT_TRUE(eventually([&] { return loop.made() > before + 4000; }));
}

}  // namespace pace_test
}  // namespace repel::runs
