// SPDX-License-Identifier: BSD-3-Clause
#include <repel/loop/readings.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include <repel/network/plan.hpp>

namespace repel {
namespace readings_test {

TEST(Readings, MissingEntriesAreNotNumbers) {
  std::vector<double> to(3, 7.0);
  copy_readings(std::array{1.0, 2.0}, to);
  EXPECT_EQ(to[0], 1.0);
  EXPECT_EQ(to[1], 2.0);
  EXPECT_TRUE(std::isnan(to[2]));
}

TEST(Readings, AWrenchThatIsMissingOrNotFiniteIsNoMeasurement) {
  const network::ForceSensor sensor;
  network::Signals signals;
  signals.inertia.setIdentity(2, 2);
  pass_wrench(Wrench{{1, 2, 3}, {4, 5, 6}}, sensor, signals);
  EXPECT_TRUE(signals.is_measured);
  EXPECT_EQ(signals.measured.torque, Vec3(4, 5, 6));
  pass_wrench({}, sensor, signals);
  EXPECT_FALSE(signals.is_measured);
  EXPECT_EQ(signals.measured.torque, Vec3::Zero());
  pass_wrench(Wrench{{1, std::nan(""), 3}, {4, 5, 6}}, sensor, signals);
  EXPECT_FALSE(signals.is_measured);
  EXPECT_TRUE(is_finite(signals.measured));
  EXPECT_EQ(signals.inertia(0, 0), 1.0) << "the sensor does not act yet";
}

TEST(Readings, TheNetworkMovesALighterArm) {
  network::ForceSensor sensor({.gain = 0.6});
  sensor.fit(network::Space::joints, 1);
  sensor.prepare(0.01);
  network::Signals signals = network::detail::neutral_signals(1, 0.01);
  signals.is_measured = true;
  for (int tick = 0; tick < 100; ++tick) sensor.read(signals);
  signals.inertia.setConstant(1, 1, 8.0);
  pass_wrench(Wrench{}, sensor, signals);
  EXPECT_NEAR(signals.inertia(0, 0), 5.0, 1e-12);
}

}  // namespace readings_test
}  // namespace repel
