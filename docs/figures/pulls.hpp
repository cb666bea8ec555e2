// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A tool that is led slowly out of a virtual fixture, and what it feels.
#pragma once

#include <cmath>
#include <vector>

#include <repel/network/modules/guide.hpp>

namespace repel::figures {

struct Pulled {
  const char* name;
  network::FixtureOptions fixture;
  Vec3 from{0, 0, 0};  ///< [m] where the way along x begins
};

/// The same point with its force limited by each of its numbers.
inline std::vector<Pulled> pulled_by_limit() {
  network::FixtureOptions energy;
  energy.most_energy = 0.8;
  network::FixtureOptions soft;
  soft.stiffness = 150.0;
  return {{"limited by its force, 30 N", {}},
          {"limited by its energy, 0.8 J", energy},
          {"soft, 150 N/m", soft}};
}

/// Each kind of shape.
inline std::vector<Pulled> pulled_by_shape() {
  network::FixtureOptions tube;
  tube.kind = network::FixtureKind::line;
  tube.radius = 0.02;
  network::FixtureOptions cone;
  cone.kind = network::FixtureKind::cone;
  return {{"point, line, plane, path", {}},
          {"tube of 20 mm", tube},
          {"cone, 80 mm above its tip", cone, Vec3(0, 0, 0.08)}};
}

struct Pull {
  double distance = 0.0;  ///< [m] from where the way begins
  double force = 0.0;     ///< [N] size of that on the tool
  double energy = 0.0;    ///< [J] stored
};

/// At 1 mm/s, 400 Hz; the fixture is switched on where it costs nothing.
inline std::vector<Pull> pull_out(const Pulled& pulled) {
  constexpr double period = 0.0025;  // [s]
  constexpr double speed = 0.001;    // [m/s]
  network::Guide guide({.fixtures = {pulled.fixture}});
  guide.prepare(period);
  network::Signals signals;
  signals.period = period;
  signals.jacobian = network::Jacobian::Zero(6, 3);
  signals.jacobian.topRows<3>().setIdentity();
  signals.X_WT.translation() = pulled.from;
  signals.rates = signals.mean_rates = network::Vec<network::any_size>::Zero(3);
  for (int tick = 0; tick < 400; ++tick) guide.read(signals);
  signals.rates[0] = signals.mean_rates[0] = speed;
  std::vector<Pull> way;
  for (int tick = 0; tick < 60000; ++tick) {
    const double x = speed * period * tick;
    signals.X_WT.translation() = pulled.from + x * Vec3::UnitX();
    guide.read(signals);
    if (tick % 400 == 0) way.push_back({x, guide.on_tool().force.norm(), guide.stored()});
  }
  return way;
}

}  // namespace repel::figures
