// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/remote/playout.hpp>

#include <gtest/gtest.h>

#include <deque>
#include <vector>

#include <repel/base/setup_error.hpp>

#include "network/drawn.hpp"

namespace repel::network {
namespace playout_test {

using test::period;

constexpr unsigned seed = 5077;

struct Path {
  double delay = 0.03;  ///< [s]
  double jitter = 0.0;  ///< [s]
  double loss = 0.0;
  double drift = 0.0;   ///< of the clock of the sender
  double rate = 400.0;  ///< [Hz] of the sender
};

/// What the receiver sees of a path: the moments, and how far the newest packet was ahead of them.
class Received {
 public:
  explicit Received(Playout& playout) : playout_(playout), rng_(seed) {}

  void run(const Path& path, double seconds) {
    const double until = now_ + seconds;
    while (now_ < until) {
      now_ += period;
      // The clocks have nothing in common but, nearly, their rate.
      for (; next_ <= now_; next_ += 1.0 / path.rate) {
        if (families::uniform(rng_, 0.0, 1.0) < path.loss) continue;
        const double there = 500.0 + next_ * (1.0 + path.drift);
        const double late = families::uniform(rng_, 0.0, 1.0) * path.jitter;
        on_the_way_.push_back({there, next_ + path.delay + late});
      }
      for (std::size_t i = 0; i < on_the_way_.size();) {
        if (on_the_way_[i].arrives > now_) {
          ++i;
          continue;
        }
        const double there = on_the_way_[i].sent;
        on_the_way_.erase(on_the_way_.begin() + static_cast<std::ptrdiff_t>(i));
        if (there <= newest_) continue;
        playout_.arrive(there, newest_ < 0.0 ? there : newest_, now_);
        newest_ = there;
      }
      const double moment = playout_.advance(now_);
      if (newest_ < 0.0) continue;
      steps.push_back(moment - moment_);
      ages.push_back(500.0 + now_ * (1.0 + path.drift) - moment);
      starved += moment > newest_ ? 1 : 0;
      moment_ = moment;
    }
  }
  void forget() {
    steps.clear();
    ages.clear();
    starved = 0;
  }

  std::vector<double> steps;  ///< [s] of the moment, in each tick
  std::vector<double> ages;   ///< [s] of the moment, by the clock of the sender
  int starved = 0;            ///< ticks whose moment is not known yet

 private:
  struct Packet {
    double sent, arrives;
  };
  Playout& playout_;
  families::Rng rng_;
  double now_ = 0.0, next_ = 0.0, newest_ = -1.0, moment_ = 0.0;
  std::deque<Packet> on_the_way_;
};

double largest(const std::vector<double>& all) {
  return *std::max_element(all.begin(), all.end());
}
double smallest(const std::vector<double>& all) {
  return *std::min_element(all.begin(), all.end());
}

TEST(Playout, FollowsAConstantDelayByAFewPeriods) {
  Playout playout(period);
  Received received(playout);
  received.run({.delay = 0.03}, 5.0);
  received.forget();
  received.run({.delay = 0.03}, 5.0);
  EXPECT_EQ(received.starved, 0);
  EXPECT_NEAR(smallest(received.steps), period, 1e-6);
  EXPECT_NEAR(largest(received.steps), period, 1e-6);
  EXPECT_GT(largest(received.ages), 0.03);
  EXPECT_LT(largest(received.ages), 0.03 + 3.0 * period);
}

// Anderson's wave variables may arrive whenever they like; the hand must not feel when.
TEST(Playout, OutputsEvenlyWhatArrivesUnevenly) {
  Playout playout(period);
  Received received(playout);
  const Path path{.delay = 0.05, .jitter = 0.0271, .loss = 0.05};
  received.run(path, 5.0);
  received.forget();
  received.run(path, 20.0);
  EXPECT_LE(received.starved, 20 * 400 / 200) << "seed " << seed;
  EXPECT_GT(smallest(received.steps), 0.94 * period);
  EXPECT_LT(largest(received.steps), 1.06 * period);
  EXPECT_LT(largest(received.ages), 0.05 + 0.2);
}

TEST(Playout, FollowsAClockThatDrifts) {
  for (const double drift : {-2e-3, -1e-4, 1e-4, 2e-3}) {
    Playout playout(period);
    Received received(playout);
    const Path path{.delay = 0.02, .jitter = 0.004, .drift = drift};
    received.run(path, 60.0);
    EXPECT_LT(largest(received.ages), 0.02 + 0.05) << drift;
    EXPECT_LE(received.starved, 60 * 400 / 200) << drift << ", seed " << seed;
  }
}

TEST(Playout, FollowsASenderOfAnotherRate) {
  for (const double rate : {100.0, 1000.0}) {
    Playout playout(period);
    Received received(playout);
    received.run({.delay = 0.02, .rate = rate}, 5.0);
    received.forget();
    received.run({.delay = 0.02, .rate = rate}, 5.0);
    EXPECT_EQ(received.starved, 0) << rate;
    EXPECT_NEAR(largest(received.steps), period, 1e-4) << rate;
  }
}

TEST(Playout, NeverGoesBackWhereTheDelayChanges) {
  Playout playout(period);
  Received received(playout);
  for (const double delay : {0.01, 0.2, 0.03, 0.4, 0.0}) {
    received.run({.delay = delay, .jitter = 0.01}, 8.0);
    received.forget();
    received.run({.delay = delay, .jitter = 0.01}, 3.0);
    EXPECT_GE(smallest(received.steps), 0.0);
    EXPECT_LT(largest(received.ages), delay + 0.1) << delay;
    EXPECT_LE(received.starved, 12) << delay << ", seed " << seed;
  }
}

TEST(Playout, KeepsTheBufferThatIsAskedFor) {
  Playout playout(period, {.buffer = 0.08});
  Received received(playout);
  received.run({.delay = 0.02, .jitter = 0.01}, 5.0);
  EXPECT_DOUBLE_EQ(playout.buffer(), 0.08);
  EXPECT_NEAR(received.ages.back(), 0.1, 2.5 * period);
  EXPECT_THROW(Playout(period, {.buffer = 11.0}), SetupError);
}

TEST(Playout, KeepsWhatItKnowsThroughASilence) {
  Playout playout(period);
  playout.arrive(10.0, 10.0, 1.0);
  const double first = playout.advance(1.0);
  for (int i = 1; i <= 4000; ++i) (void)playout.advance(1.0 + i * period);
  EXPECT_NEAR(playout.advance(11.0) - first, 10.0, 1e-9);
}

}  // namespace playout_test
}  // namespace repel::network
