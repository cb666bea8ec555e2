// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/elements/wave_account.hpp>

#include <gtest/gtest.h>

#include "network/drawn.hpp"

namespace repel::network {
namespace wave_account_test {

using test::period;

constexpr unsigned seed = 811;

TEST(WaveAccount, GivesBackWhatWasAddedWaveByWave) {
  families::Rng rng(seed);
  SCOPED_TRACE("seed " + std::to_string(seed));
  WaveAccount sent, drawn;
  sent.clear(6);
  drawn.clear(6);
  for (int i = 0; i < 1000; ++i) {
    const Vector wave = test::drawn_vector(rng, 6, 3.0);
    sent.add(wave, period);
    const Vector out = drawn.draw(sent.sum - drawn.sum, sent.energy - drawn.energy, period);
    ASSERT_LE((out - wave).norm(), 1e-9);
  }
  EXPECT_NEAR(drawn.energy, sent.energy, 1e-9 * sent.energy);
}

TEST(WaveAccount, DrawsNoMoreThanIsAllowed) {
  WaveAccount drawn;
  drawn.clear(1);
  // 3 sqrt(W) for a period have 9 W.
  const Vector missing = Vector::Constant(1, 3.0 * period);
  EXPECT_NEAR(drawn.draw(missing, 4.0 * period, period)(0), 2.0, 1e-12);
  EXPECT_NEAR(drawn.energy, 4.0 * period, 1e-15);
  EXPECT_NEAR(drawn.sum(0), 2.0 * period, 1e-15);
  EXPECT_EQ(drawn.draw(missing, -1.0, period)(0), 0.0);
  EXPECT_NEAR(drawn.energy, 4.0 * period, 1e-15);
}

TEST(LineImpedance, HasTheAngularOneForTheLastThreeOfATool) {
  const LineImpedance Z(Space::tool, 6, 20.0, 0.5);
  EXPECT_EQ(Z.diagonal().head<3>(), Vec3::Constant(20.0));
  EXPECT_EQ(Z.diagonal().tail<3>(), Vec3::Constant(0.5));
  EXPECT_EQ(LineImpedance(Space::joints, 6, 20.0, 0.5).diagonal(), Vector::Constant(6, 20.0));
}

TEST(LineImpedance, ItsWavesCarryThePower) {
  families::Rng rng(seed);
  SCOPED_TRACE("seed " + std::to_string(seed));
  const LineImpedance Z(Space::tool, 6, 20.0, 0.5);
  for (int i = 0; i < 100; ++i) {
    // An end at which the wave `out` comes out: f = Z v + b.
    const Vector out = test::drawn_vector(rng, 6, 2.0);
    const Vector flow = test::drawn_vector(rng, 6, 0.5);
    const test::State state{product(Z.diagonal(), flow) + Z.offset_of(out), flow};
    EXPECT_NEAR(state.power(), Z.wave_of(state).squaredNorm() - out.squaredNorm(), 1e-12);
  }
}

}  // namespace wave_account_test
}  // namespace repel::network
