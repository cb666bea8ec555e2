// SPDX-License-Identifier: BSD-3-Clause
#include <repel/loop/arms/motion_account.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <deque>

#include "loop/slider.hpp"

namespace repel {
namespace motion_account_test {

constexpr double T = 0.0025;

struct Case {
  double mass = 5.0;     // [kg] of the true slider; the model has 5
  double payload = 0.0;  // [N]
  double dry = 0.0;      // [N]
  int late = 0;          // [ticks] of the readings, not told
};

/// [J] Most gained in ten seconds beyond its error, by a slider that a spring and a damper move to
/// and fro.
double gained(const Case& now) {
  const ArmModel model = test::slider_model(1000.0);
  MotionAccount account(model);
  SentTorques sent(3, 0.0);
  const ArmInertia::Matrix M = 5.0 * ArmInertia::Matrix::Identity(3, 3);
  std::deque<double> told(static_cast<std::size_t>(now.late) + 1, 0.0);
  std::deque<double> at(told);
  std::vector<double> last(3, 0.0), v(3, 0.0);
  double q = 0.0, rate = 0.0, most = 0.0, peak = 0.0;
  for (int tick = 0; tick < 4000; ++tick) {
    told.push_front(rate);
    told.pop_back();
    at.push_front(q);
    at.pop_back();
    v[0] = told.back();
    account.step(last, v, M, sent, T);
    last = v;
    peak = std::max(peak, account.kinetic());
    most = std::max(most, account.gained() - peak);
    const double goal = 0.05 * std::sin(2.0 * tick * T);
    const double force = 20000.0 * (goal - at.back()) - 100.0 * v[0];
    SentTorques::Vector net = SentTorques::Vector::Zero(3);
    net(0) = std::clamp(force, -400.0, 400.0);
    sent.add(net);
    const double driven = rate + T * (net(0) - now.payload) / now.mass;
    const double left = std::max(0.0, std::abs(driven) - T * now.dry / now.mass);
    rate = std::copysign(left, driven) / (1.0 + T * 20.0 / now.mass);
    q += T * rate;
  }
  return most;
}

TEST(MotionAccount, NothingIsGainedByAnArmThatFollowsItsTorques) {
  EXPECT_LT(gained({}), 0.1);
  EXPECT_LT(gained({.mass = 3.0}), 0.1);
  EXPECT_LT(gained({.mass = 8.5}), 1.0);
  EXPECT_LT(gained({.payload = 20.0}), 0.5);
  EXPECT_LT(gained({.dry = 20.0}), 0.1);
}

// A limit cycle at 1.3 m/s was not noticed for 0.7 s.
TEST(MotionAccount, ReadingsThatAreLaterThanToldShowAsEnergy) {
  EXPECT_GT(gained({.late = 6}), 50.0);
}

}  // namespace motion_account_test
}  // namespace repel
