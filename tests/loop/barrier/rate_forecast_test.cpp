// SPDX-License-Identifier: BSD-3-Clause
#include <repel/loop/barrier/rate_forecast.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include <repel/loop/arms/arm_inertia.hpp>

#include "loop/slider.hpp"

namespace repel {
namespace rate_forecast_test {

constexpr double period = 2.5e-3;  // [s]

/// What the true rail has otherwise than its model.
struct Truth {
  double mass = 1.0;      // as a multiple
  double friction = 0.0;  // [N] dry
};

/// Three rails, of which the first is pushed to and fro with a drive that is late.
struct Late {
  Late(int delay, double told, const Truth& is)
      : model(test::slider_model(0.0)),
        inertia(model),
        forecast(model, period, told, period),
        truth(is),
        late(static_cast<std::size_t>(delay), 0.0) {
    for (ArmLink& link : model.links) link.viscous_friction = 0.0;
    test::SliderKinematics kinematics;
    kinematics.update(std::vector<double>(3, 0.0));
    EXPECT_TRUE(inertia.update(kinematics));
    const auto& M = inertia.matrix();
    EXPECT_TRUE(mass.factor(3, [&](Eigen::Index i) { return M.data()[i]; }));
  }
  /// One tick with `force` [N]. Returns the rate that is predicted for the end of the delay.
  double tick(double force) {
    const std::vector<double> rates{v, 0.0, 0.0};
    forecast.observe(rates, inertia);
    forecast.predict(rates, inertia, mass);
    const double predicted = v + forecast.least_gain(x) + forecast.doubt(0);
    RateForecast::Vector net = RateForecast::Vector::Zero(3);
    net.coeffRef(0) = force;
    forecast.note_sent(net);
    late.push_back(force);
    const double own = truth.mass * inertia.matrix()(0, 0);
    const double free = v + period / own * late.front();
    late.erase(late.begin());
    v = std::copysign(std::max(0.0, std::abs(free) - period / own * truth.friction), free);
    return predicted;
  }
  ArmModel model;
  ArmInertia inertia;
  network::dense::Factored mass;
  RateForecast forecast;
  Truth truth;
  std::vector<double> late;
  double v = 0.0;
  const RateForecast::Vector x = RateForecast::Vector::Unit(3, 0);
};

double to_and_fro(int tick) {
  return 20.0 * std::sin(0.2 * tick);
}

TEST(RateForecast, KnowsWhatWasSentAndHasNotActedYet) {
  Late rail(3, 3.0, {});
  std::vector<double> predicted;
  for (int tick = 0; tick < 400; ++tick) {
    predicted.push_back(rail.tick(to_and_fro(tick)));
    if (tick < 10) continue;
    EXPECT_NEAR(predicted[static_cast<std::size_t>(tick) - 2], rail.v, 1e-9) << tick;
  }
  EXPECT_LT(rail.forecast.doubt(0), 1e-9);
}

// A rail with dry friction was predicted to stop, and went on: the low-pass knows it too late.
TEST(RateForecast, IsInDoubtByAsMuchAsItWasWrongOfLate) {
  for (const Truth& truth : {Truth{.friction = 6.0}, Truth{.mass = 0.6}, Truth{.mass = 1.7}}) {
    SCOPED_TRACE(std::to_string(truth.mass) + " of the mass, " + std::to_string(truth.friction) +
                 " N of friction");
    Late rail(3, 3.0, truth);
    std::vector<double> least;
    double worst = 0.0;  // [m/s] below what it may be at least
    double error = 0.0;  // [m/s]
    for (int tick = 0; tick < 2000; ++tick) {
      const double predicted = rail.tick(to_and_fro(tick));
      least.push_back(predicted - rail.forecast.doubt(0));
      if (tick < 200) continue;
      const double then = least[static_cast<std::size_t>(tick) - 2];
      worst = std::max(worst, then - rail.v);
      error = std::max(error, rail.forecast.doubt(0));
    }
    EXPECT_GT(error, 1e-3) << "the sample must be hard to predict";
    EXPECT_LT(worst, 0.2 * error);
  }
}

// A prediction for half a tick is compared with the rate between two ticks.
TEST(RateForecast, IsNotInDoubtOfADelayThatIsNoWholeNumber) {
  Late rail(0, 0.0, {});
  RateForecast half(rail.model, period, 0.5, period);
  const auto& M = rail.inertia.matrix();
  const double per_newton = period / M(0, 0);
  double v = 0.0;
  double before = 0.0;
  double most = 0.0;
  for (int tick = 0; tick < 400; ++tick) {
    const std::vector<double> rates{v, 0.0, 0.0};
    half.observe(rates, rail.inertia);
    half.predict(rates, rail.inertia, rail.mass);
    if (tick > 350) most = std::max(most, half.doubt(0));
    RateForecast::Vector net = RateForecast::Vector::Zero(3);
    net.coeffRef(0) = 20.0;
    half.note_sent(net);
    v += per_newton * 0.5 * (before + 20.0);
    before = 20.0;
  }
  EXPECT_LT(most, 0.02 * per_newton * 20.0);
}

TEST(RateForecast, DoesNotCompareAcrossAGap) {
  Late rail(3, 3.0, {});
  for (int tick = 0; tick < 100; ++tick) (void)rail.tick(to_and_fro(tick));
  rail.forecast.forget();
  rail.v += 0.5;
  (void)rail.tick(0.0);
  EXPECT_LT(rail.forecast.doubt(0), 1e-9);
}

}  // namespace rate_forecast_test
}  // namespace repel
