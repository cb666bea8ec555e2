// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/remote/wave_player.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "network/drawn.hpp"

namespace repel::network {
namespace wave_player_test {

constexpr unsigned seed = 9001;

/// A sender of waves, whose packets reach a player over a path with constant delay.
struct Sender {
  double period;
  int size = 1;
  RemotePacket packet{};
  WaveAccount sent{};

  const RemotePacket& send(const Vector& wave) {
    if (packet.sequence == 0) sent.clear(size);
    sent.add(wave, period);
    packet.session = 3;
    ++packet.sequence;
    packet.sent = std::llround(1e9 * period * static_cast<double>(packet.sequence));
    packet.energy_sent = sent.energy;
    std::copy_n(sent.sum.data(), size, packet.sum.begin());
    return packet;
  }
};

Vector one(double x) {
  return Vector::Constant(1, x);
}

/// Plays 20 s of `wave` from a sender of `rate` [Hz] at 400 Hz; returns what comes out.
std::vector<double> played(double rate, const std::function<double(double)>& wave) {
  constexpr double period = 0.0025;
  WavePlayer player(1, period);
  Sender sender{1.0 / rate};
  std::vector<double> out;
  double next = sender.period;
  for (int tick = 1; tick <= 8000; ++tick) {
    const double now = tick * period;
    for (; next <= now + 1e-9; next += sender.period) {
      EXPECT_TRUE(player.arrive(sender.send(one(wave(next))), now));
    }
    out.push_back(player.step(now, false)(0));
    EXPECT_LE(player.output(), sender.sent.energy * (1.0 + 1e-12));
  }
  return out;
}

TEST(WavePlayer, OutputsASineOfAnotherRateAsItWas) {
  for (const double rate : {100.0, 400.0, 1000.0, 317.0}) {
    const double turn = 2.0 * 3.14159265358979323846 * 1.0;
    const std::vector<double> out = played(rate, [&](double t) { return std::sin(turn * t); });
    double largest = 0.0, jump = 0.0, energy = 0.0;
    for (std::size_t i = 4000; i < out.size(); ++i) {
      largest = std::max(largest, std::abs(out[i]));
      jump = std::max(jump, std::abs(out[i] - out[i - 1]));
      energy += 0.0025 * out[i] * out[i];
    }
    EXPECT_NEAR(largest, 1.0, 0.01) << rate;
    EXPECT_NEAR(energy, 5.0, 0.1) << rate;
    // One tick of a sine, or one period of its sender.
    EXPECT_LT(jump, 1.1 * turn * std::max(0.0025, 1.0 / rate)) << rate;
  }
}

/// Ten seconds over a path that loses, doubles and reorders.
struct Rough {
  double sent = 0.0, output = 0.0;          ///< [J]
  double sum_sent = 0.0, sum_output = 0.0;  ///< [sqrt(J s)]
};
Rough over_a_rough_path(families::Rng& rng, double loss, double jitter, double mean) {
  constexpr double period = 0.0025;
  WavePlayer player(6, period);
  Sender sender{period, 6};
  std::vector<std::pair<double, RemotePacket>> on_the_way;
  Rough rough;
  for (int tick = 1; tick <= 4000; ++tick) {
    const double now = tick * period;
    const bool waves = tick < 3800;
    const Vector wave = waves ? Vector(test::drawn_vector(rng, 6, 2.0) + Vector::Constant(6, mean))
                              : Vector::Zero(6);
    rough.sum_sent += period * wave(0);
    const RemotePacket& packet = sender.send(wave);
    for (int copies = families::count_between(rng, 1, 2); copies > 0; --copies) {
      if (families::uniform(rng, 0.0, 1.0) < loss) continue;
      on_the_way.push_back({now + families::uniform(rng, 0.0, 1.0) * jitter, packet});
    }
    std::erase_if(on_the_way, [&](const auto& each) {
      if (each.first > now) return false;
      (void)player.arrive(each.second, now);
      return true;
    });
    const Vector out = player.step(now, false);
    rough.output += period * out.squaredNorm();
    rough.sum_output += period * out(0);
    EXPECT_LE(rough.output, sender.sent.energy * (1.0 + 1e-9));
    EXPECT_NEAR(player.output(), rough.output, 1e-9 * (1.0 + rough.output));
    EXPECT_GE(player.withheld(), -1e-9 * rough.output);
  }
  rough.sent = sender.sent.energy;
  return rough;
}

TEST(WavePlayer, OutputsNoMoreEnergyThanWasSent) {
  families::Rng rng(seed);
  for (int i = 0; i < families::draws(60); ++i) {
    SCOPED_TRACE(families::of_seed(seed, "path", i));
    const double loss = families::uniform(rng, 0.0, 0.9);
    const Rough rough = over_a_rough_path(rng, loss, families::uniform(rng, 0.0, 0.1), 0.0);
    EXPECT_GT(rough.output, 0.01 * (1.0 - loss) * rough.sent);
  }
}

TEST(WavePlayer, LosesNoMotionWhereSinglePacketsAreLost) {
  families::Rng rng(seed);
  for (int i = 0; i < families::draws(20); ++i) {
    SCOPED_TRACE(families::of_seed(seed, "path", i));
    const Rough rough = over_a_rough_path(rng, 0.1, families::uniform(rng, 0.0, 0.03), 3.0);
    EXPECT_NEAR(rough.sum_output / rough.sum_sent, 1.0, 0.02);
  }
}

// What was held back by the network for longer would otherwise come out at once, as a kick.
TEST(WavePlayer, DropsWhatWasSentInASilence) {
  constexpr double period = 0.0025;
  WavePlayer player(1, period);
  Sender sender{period};
  double largest = 0.0;
  for (int tick = 1; tick <= 4000; ++tick) {
    const RemotePacket& packet = sender.send(one(1.0));
    const bool silent = tick > 1000 && tick <= 1400;
    if (!silent) (void)player.arrive(packet, tick * period);
    const double out = player.step(tick * period, false)(0);
    if (tick > 1020 && tick <= 1400) {
      EXPECT_EQ(out, 0.0);
    }
    largest = std::max(largest, out);
  }
  EXPECT_LE(largest, 1.1);
  EXPECT_NEAR(player.withheld(), 1.0, 0.1);  // 400 ticks of 1 W
}

TEST(WavePlayer, CatchesUpSmoothlyAfterAShortGap) {
  constexpr double period = 0.0025;
  WavePlayer player(1, period);
  Sender sender{period};
  double largest = 0.0, sum = 0.0;
  for (int tick = 1; tick <= 4000; ++tick) {
    const RemotePacket& packet = sender.send(one(1.0));
    if (tick <= 1000 || tick > 1020) (void)player.arrive(packet, tick * period);
    const double out = player.step(tick * period, false)(0);
    if (tick > 1020) largest = std::max(largest, out);
    sum += period * out;
  }
  EXPECT_LE(largest, 4.0);
  EXPECT_GT(sum, 4000 * period - 0.04);
}

TEST(WavePlayer, AtRestNothingComesOutNorLater) {
  constexpr double period = 0.0025;
  WavePlayer player(1, period);
  Sender sender{period};
  double largest = 0.0;
  for (int tick = 1; tick <= 2000; ++tick) {
    (void)player.arrive(sender.send(one(1.0)), tick * period);
    const bool at_rest = tick > 500 && tick <= 1500;
    const double out = player.step(tick * period, at_rest)(0);
    if (at_rest) {
      EXPECT_EQ(out, 0.0);
    }
    largest = std::max(largest, out);
  }
  EXPECT_LE(largest, 1.0 + 1e-9);
}

TEST(WavePlayer, RefusesCopiesAndContradictions) {
  WavePlayer player(1, 0.0025);
  Sender sender{0.0025};
  const RemotePacket first = sender.send(one(1.0));
  const RemotePacket second = sender.send(one(1.0));
  RemotePacket third = sender.send(one(1.0));
  EXPECT_TRUE(player.arrive(first, 0.01));
  EXPECT_TRUE(player.arrive(second, 0.01));
  EXPECT_FALSE(player.arrive(first, 0.01));
  EXPECT_FALSE(player.arrive(second, 0.01));
  third.energy_sent = 0.5 * second.energy_sent;
  EXPECT_FALSE(player.arrive(third, 0.01));
  third.energy_sent = second.energy_sent;
  third.sent = second.sent;
  EXPECT_FALSE(player.arrive(third, 0.01));
  EXPECT_EQ(player.newest(), 2);
}

// Finite all the same: sums of 1e308 and an energy of 1e300 J once stayed in the sums for good.
TEST(WavePlayer, RefusesWavesThatCannotBe) {
  constexpr double period = 0.0025;
  WavePlayer player(1, period);
  player.set_most_power(100.0);
  Sender sender{period};
  for (int i = 1; i <= 20; ++i) EXPECT_TRUE(player.arrive(sender.send(one(1.0)), i * period));
  const RemotePacket next = sender.send(one(1.0));
  RemotePacket wrong = next;
  wrong.sum[0] = 1e308;
  wrong.energy_sent = 1e300;
  EXPECT_FALSE(player.is_credible(wrong));
  EXPECT_FALSE(player.arrive(wrong, 21 * period));
  wrong.energy_sent = next.energy_sent;  // motion without energy
  wrong.sum[0] = next.sum[0] + 10.0;
  EXPECT_FALSE(player.arrive(wrong, 21 * period));
  wrong.sum[0] = next.sum[0];  // a wave of 2000 sqrt(W) where none is above 10
  wrong.energy_sent = next.energy_sent + period * 4e6;
  EXPECT_FALSE(player.arrive(wrong, 21 * period));
  wrong = sender.packet;  // the same of one that was overtaken
  EXPECT_TRUE(player.arrive(sender.send(one(1.0)), 22 * period));
  wrong.sum[0] -= 10.0;
  EXPECT_FALSE(player.arrive(wrong, 22 * period));
  EXPECT_TRUE(player.arrive(next, 22 * period));
  EXPECT_TRUE(std::isfinite(player.step(22 * period, false)(0)));
}

TEST(WavePlayer, TellsWavesBeyondTheBoundsFromSoundOnesWhateverTheJitter) {
  constexpr double period = 0.0025;
  families::Rng rng(seed);
  SCOPED_TRACE("seed " + std::to_string(seed));
  WavePlayer player(1, period);
  player.set_most_power(100.0);
  Sender sender{period};
  const auto send = [&](double wave, int ticks) {
    int beyond = 0;
    for (int i = 0; i < ticks; ++i) {
      RemotePacket packet = sender.send(one(wave));
      // The tick was late by a little, and the packet by more.
      packet.sent += std::llround(1e6 * families::uniform(rng, 0.0, 1.0));
      const double now = 1e-9 * static_cast<double>(packet.sent) + 0.05;
      if (player.arrive(packet, now) && player.is_beyond()) ++beyond;
    }
    return beyond;
  };
  EXPECT_EQ(send(10.0, 4000), 0);
  EXPECT_GT(send(11.0, 4000), 3000);
  EXPECT_LT(send(9.0, 4000), 1500);
  EXPECT_EQ(send(9.0, 4000), 0);
}

}  // namespace wave_player_test
}  // namespace repel::network
