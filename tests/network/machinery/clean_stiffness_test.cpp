// SPDX-License-Identifier: BSD-3-Clause
// Included first: the to_text of a space must not hide that of a number.
#include <repel/network/elements/port.hpp>

#include <repel/base/setup_error.hpp>
#include <repel/network/machinery/clean_stiffness.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <deque>
#include <vector>

namespace repel::network {
namespace clean_stiffness_test {

constexpr double T = 0.0025;
constexpr int parts = 20;  // of a period

/// A wall f = K x + B (x - x of the last sample) / T, sampled, delayed by some parts of a period,
/// and held. Bilateral: contact is never lost.
class Wall {
 public:
  Wall(double stiffness, double damping, int late)
      : K_(stiffness), B_(damping), under_way_(static_cast<std::size_t>(late), 0.0) {}
  /// The force against `x` in this part of a period.
  double at(int part, double x) {
    if (part % parts == 0) {
      asked_ = K_ * x + B_ * (part > 0 ? (x - last_) / T : 0.0);
      last_ = x;
    }
    under_way_.push_back(asked_);
    const double force = under_way_.front();
    under_way_.pop_front();
    return force;
  }

 private:
  double K_, B_;
  double asked_ = 0.0, last_ = 0.0;
  std::deque<double> under_way_;
};

/// Energy [J] that a hand moving back and forth at 0.1 m/s extracts from wall and device.
/// @param periods from one reversal to the next
double energy_won(const CleanStiffness& at, double stiffness, int periods) {
  const int late = static_cast<int>(std::lround(at.delay / T * parts));
  Wall wall(stiffness, at.wall_damping, late);
  const double step = 0.1 * T / parts;
  double x = -0.5 * step * periods * parts;
  double won = 0.0;
  const int turn = periods * parts;
  const int begin = 8 * turn;
  for (int part = 0; part < 24 * turn; ++part) {
    const double dx = part / turn % 2 == 0 ? step : -step;
    const double force = wall.at(part, x);
    x += dx;
    if (part >= begin) won -= force * dx + at.device_damping * 0.1 * std::abs(dx);
  }
  return won;
}

struct Case {
  double stiffness, wall_damping, delay;
  int periods;  // the motion that extracts most
};
// A wall with damping of its own yields most to a hand that reverses at every sample.
const std::vector<Case> cases{{1000.0, 0.0, 0.0, 1},       {1000.0, 0.0, 0.0, 1000},
                              {5000.0, 0.0, 0.0, 17},      {1000.0, -0.5, 0.0, 1000},
                              {1000.0, 3.0, 0.0, 1},       {1000.0, 0.0, T, 2000},
                              {1000.0, 0.0, 1.5 * T, 2000}};

TEST(CleanStiffness, AHandWinsEnergyAboveTheLimitAndNoneBelow) {
  for (const Case& c : cases) {
    SCOPED_TRACE("K " + repel::to_text(c.stiffness) + ", B " + repel::to_text(c.wall_damping) +
                 ", delay " + repel::to_text(c.delay) + ", " + std::to_string(c.periods) +
                 " periods");
    CleanStiffness at{.period = T, .wall_damping = c.wall_damping, .delay = c.delay};
    const double needed = at.needed_damping(c.stiffness);
    at.device_damping = 1.02 * needed;
    EXPECT_GT(at.limit(), c.stiffness);
    EXPECT_LT(energy_won(at, c.stiffness, c.periods), 0.0);
    at.device_damping = 0.98 * needed;
    EXPECT_LT(at.limit(), c.stiffness);
    EXPECT_GT(energy_won(at, c.stiffness, c.periods), 0.0);
  }
}

/// Largest amplitude of a mass of 0.2 kg on the wall at the end, relative to that at the beginning.
double growth(const CleanStiffness& at, double stiffness) {
  constexpr double mass = 0.2;
  Wall wall(stiffness, at.wall_damping, static_cast<int>(std::lround(at.delay / T * parts)));
  double x = 0.0;
  double v = 0.1;
  double first = 0.0;
  double last = 0.0;
  const double dt = T / parts;
  const double fade = std::exp(-at.device_damping / mass * dt);
  constexpr int all = 4000 * parts;
  for (int part = 0; part < all; ++part) {
    const double end =
        -wall.at(part, x) / at.device_damping;  // the rate to which it would converge
    x += end * dt + (v - end) * (1.0 - fade) * mass / at.device_damping;
    v = end + (v - end) * fade;
    if (part < all / 10) first = std::max(first, std::abs(x));
    if (part > all - all / 10) last = std::max(last, std::abs(x));
  }
  return last / first;
}

TEST(CleanStiffness, AMassOnTheWallSwingsUpAboveTheLimitAndCalmsDownBelow) {
  for (const double stiffness : {50.0, 200.0}) {
    for (const double delay : {0.0, T, 1.5 * T}) {
      SCOPED_TRACE("K " + repel::to_text(stiffness) + ", delay " + repel::to_text(delay));
      CleanStiffness at{.period = T, .delay = delay};
      const double needed = at.needed_damping(stiffness);
      at.device_damping = 1.1 * needed;
      EXPECT_LT(stiffness, at.limit());
      EXPECT_LT(growth(at, stiffness), 1.0);
      at.device_damping = 0.9 * needed;
      EXPECT_GT(stiffness, at.limit());
      EXPECT_GT(growth(at, stiffness), 1.0);
    }
  }
}

TEST(CleanStiffness, LimitAndNeededDampingAreOneFormula) {
  const CleanStiffness at{
      .period = 0.002, .device_damping = 10.0, .wall_damping = -4.0, .delay = 0.001};
  EXPECT_DOUBLE_EQ(at.limit(), (10.0 - 4.0) / (0.001 + 0.001));
  EXPECT_DOUBLE_EQ(at.needed_damping(at.limit()), 10.0);
  CleanStiffness positive = at;
  positive.wall_damping = 4.0;
  EXPECT_EQ(positive.limit(), at.limit());
  positive.wall_damping = 10.0;
  EXPECT_EQ(positive.limit(), 0.0);
  EXPECT_EQ(CleanStiffness{}.limit(), 0.0);
}

}  // namespace clean_stiffness_test
}  // namespace repel::network
