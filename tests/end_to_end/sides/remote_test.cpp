// SPDX-License-Identifier: BSD-3-Clause
// A scene in two programs, in step: the real ones, but for the clock and a path that is simulated.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <repel/runs/station/site_twin.hpp>
#include <repel/scene/scene.hpp>

#include "end_to_end/program.hpp"
#include "end_to_end/two_sides.hpp"
#include "network/remote/relay.hpp"

namespace repel::test {
namespace remote_test {

constexpr unsigned seed = 1993;

scene::Scene delayed() {
  return scene::load(REPEL_SOURCE "/scenes/delayed.yaml");
}

/// [rad/s] The fastest joint of the last tick.
double speed(const Site& site) {
  double fastest = 0.0;
  for (const double v : site.last.v) fastest = std::max(fastest, std::abs(v));
  return fastest;
}

/// Both, the path between them, and what was worst.
struct Divided {
  scene::Scene scene;
  RelayPath path;
  std::unique_ptr<Site> site;
  std::unique_ptr<Station> station;
  Relay forth{seed}, back{seed + 1};
  double now = 0.0;
  double nearest = 1.0;    ///< [m]
  double fastest = 0.0;    ///< [m/s] of the tool
  double hardest = 0.0;    ///< [N] of the walls
  double strongest = 0.0;  ///< [N m] at the lever

  explicit Divided(const RelayPath& on, const scene::Scene& divided = delayed())
      : scene(divided), path(on) {
    site = std::make_unique<Site>(scene, 1);
    station = std::make_unique<Station>(scene, 2);
  }
  void run(double seconds, bool has_station = true, bool has_site = true) {
    for (const double until = now + seconds; now < until;) {
      now += tick;
      if (has_site) {
        site->step(now);
        nearest = std::min(nearest, site->last.pairs.nearest);
        fastest = std::max(fastest, norm(site->last.v_WT));
        hardest = std::max(hardest, norm(site->last.virtual_force.force));
      }
      if (has_station) {
        // The clocks of two machines have nothing in common.
        station->side.tick(at(5e4 + now), tick);
        strongest = std::max(strongest, std::abs(station->side.felt()));
      }
      forth.carry(station->link, site->link, path, now);
      back.carry(site->link, station->link, path, now);
    }
  }
  void expect_ledgers_hold() const {
    const std::array<const network::Network*, 2> networks{&site->prepared->cell.network(0),
                                                          &station->side.network()};
    for (const network::Network* each : networks) {
      for (const network::Node& node : each->nodes()) {
        if (!node.traits.passive) continue;
        EXPECT_LE(node.ledger.deficit(), 1e-9) << node.name;
      }
    }
    // What one side has output, the other has sent.
    EXPECT_LE(site->link.player().output(), station->link.energy_sent() * (1.0 + 1e-9));
    EXPECT_LE(station->link.player().output(), site->link.energy_sent() * (1.0 + 1e-9));
  }
};

TEST(Remote, TheOperatorFeelsTheWallAndTheWallIsKept) {
  for (const double delay : {0.0, 0.05, 0.2}) {
    SCOPED_TRACE("delay " + std::to_string(delay) + " s, seed " + std::to_string(seed));
    Divided divided({.delay = delay, .jitter = 0.0071, .loss = 0.05});
    divided.run(7.0);
    // The script holds the tool on the table.
    EXPECT_GT(divided.hardest, 20.0);
    EXPECT_GT(divided.nearest, 2e-3);
    EXPECT_LT(divided.nearest, 9e-3);
    EXPECT_GT(divided.strongest, 1.0);
    EXPECT_LT(divided.fastest, 0.3);
    divided.run(8.0);
    EXPECT_GT(divided.nearest, 2e-3);
    EXPECT_LT(speed(*divided.site), 0.02);
    EXPECT_EQ(divided.site->last.status & status::energy_gain, 0U);
    divided.expect_ledgers_hold();
  }
}

TEST(Remote, EitherSideMayEndAndBeginAnew) {
  for (const double delay : {0.0, 0.2}) {
    SCOPED_TRACE("delay " + std::to_string(delay) + " s, seed " + std::to_string(seed));
    Divided divided({.delay = delay, .jitter = 0.0071, .loss = 0.05});
    divided.run(5.0);
    // The station is killed while its operator leans on the table: the robot rests within a second.
    divided.run(delay + 1.0, false, true);
    EXPECT_LT(speed(*divided.site), 1e-3);
    EXPECT_NE(divided.site->last.status & status::silent_device, 0U);
    EXPECT_EQ(divided.site->last.gain, 0.0);
    divided.run(2.0, false, true);
    EXPECT_LT(speed(*divided.site), 1e-3);
    // Another one lowers the tool once more, onto the same table.
    divided.station = std::make_unique<Station>(divided.scene, 3);
    divided.run(6.0);
    EXPECT_EQ(divided.site->link.counts().sessions, 2);
    EXPECT_EQ(divided.site->last.gain, 1.0);
    EXPECT_GT(norm(divided.site->last.virtual_force.force), 10.0);
    // The site is killed: the hand meets a damper, and nothing is left in the lever.
    divided.run(1.0, true, false);
    EXPECT_FALSE(divided.station->side.is_heard());
    EXPECT_LT(std::abs(divided.station->side.felt()), 0.5);
    divided.site = std::make_unique<Site>(divided.scene, 4);
    divided.run(6.0);
    EXPECT_EQ(divided.station->link.counts().sessions, 2);
    EXPECT_TRUE(divided.station->side.is_heard());
    EXPECT_GT(divided.nearest, 2e-3);
    EXPECT_LT(divided.fastest, 0.3);
    divided.expect_ledgers_hold();
  }
}

TEST(Remote, AloneTheRobotHoldsAndNothingIsFelt) {
  Divided divided({.loss = 1.0});
  divided.run(2.0);
  EXPECT_LT(divided.fastest, 0.01);
  EXPECT_NE(divided.site->last.status & status::silent_device, 0U);
  EXPECT_FALSE(divided.station->side.is_heard());
  EXPECT_EQ(divided.station->link.counts().received, 0);
}

TEST(Remote, IsTheSameNetworkAsInOneProgram) {
  // The names of all modules, and the line at both ends.
  const Divided divided({});
  std::vector<std::string> names;
  for (const network::Node& node : divided.station->side.network().nodes()) {
    names.push_back(node.name);
  }
  EXPECT_EQ(names, (std::vector<std::string>{"torque_arm", "multiplex", "line"}));
  names.clear();
  for (const network::Node& node : divided.site->prepared->cell.network(0).nodes()) {
    names.push_back(node.name);
  }
  EXPECT_EQ(names, (std::vector<std::string>{"line", "kbb2", "obstacle", "puma_kin", "arm_obstacle",
                                             "limits", "visual", "puma_joints", "prediction"}));
}

/// The scene `delayed` with another script, a part beside the tool that it takes along and puts
/// down, one that comes later, and a door that moves to and fro.
scene::Scene with_parts() {
  std::string text = text_of(REPEL_SOURCE "/scenes/delayed.yaml");
  text.resize(text.find("script:"));
  const std::string obstacles = "obstacles:\n";
  text.insert(
      text.find(obstacles) + obstacles.size(),
      "  - {name: door, shape: box, size: 50 50 50 mm, position: 0.3 0.4 0.6 m, law: wall,\n"
      "     motion: {along: 0 0.1 0 m, duration: 2 s}}\n");
  text +=
      "loose:\n"
      "  - {name: ball, shape: sphere, radius: 10 mm, position: 0.6263 -0.15 0.5343 m, law: wall}\n"
      "  - {name: late, shape: sphere, radius: 10 mm, position: 0.3 -0.6 0.6 m, law: wall,\n"
      "     at_start: no}\n"
      "script:\n"
      "  - {name: take, device: torque_arm, duration: 1 s, direction: 0 0 1, lever: 10 deg/s,\n"
      "     grip: ball, over: 0.1 s}\n"
      "  - {name: put, device: torque_arm, duration: 1 s, direction: 0 1 0, lever: 10 deg/s,\n"
      "     release: ball, over: 0.1 s}\n"
      "  - {name: come, device: torque_arm, duration: 1 s, direction: 0 1 0, lever: 0 deg/s,\n"
      "     spawn: late, over: 0.1 s}\n"
      "  - {name: go, device: torque_arm, duration: 1 s, direction: 0 1 0, lever: 0 deg/s,\n"
      "     remove: ball, over: 0.1 s}\n";
  return scene::parse(text, REPEL_SOURCE "/scenes/delayed.yaml");
}

/// All that the site knows of its bodies after each of its ticks.
struct SiteHistory {
  std::vector<std::vector<BodyState>> ticks;

  void note(const Site& site) { ticks.push_back(site.prepared->cell.world().motion().bodies); }
};

/// How often the parts of the scene were seen so.
struct Seen {
  int pictures = 0, held = 0, moved = 0, late = 0, gone = 0;
};

/// Every body is where it was at the site in the tick that was told last.
void expect_placed_as_told(const Snapshot& shown, const std::vector<BodyState>& at_site,
                           const Cell& twin, Seen& seen) {
  ++seen.pictures;
  for (std::size_t i = 0; i < at_site.size(); ++i) {
    const bool is_there = !at_site[i].is_loose || at_site[i].presence.is_there();
    // A part is told of every other tick: what comes or goes may be shown a tick late.
    if (shown.is_there[i] == 0 || !is_there) continue;
    const double off = (shown.X_WB[i].matrix() - at_site[i].X_WB.matrix()).norm();
    EXPECT_LT(off, at_site[i].is_loose ? 1e-3 : 1e-9)
        << twin.world().body_name({static_cast<std::int32_t>(i)});
  }
  const auto body_of = [&](std::size_t part) {
    return static_cast<std::size_t>(twin.world().part(twin.loose()[part]).body.index);
  };
  seen.held += at_site[body_of(0)].arm.valid() ? 1 : 0;
  seen.late += shown.is_there[body_of(1)];
  seen.gone += 1 - shown.is_there[body_of(0)];
}

TEST(Remote, AStationShowsTheSiteWhereItSaysThatItIs) {
  for (const double delay : {0.0, 0.05}) {
    SCOPED_TRACE("delay " + std::to_string(delay) + " s, seed " + std::to_string(seed));
    Divided divided({.delay = delay, .jitter = 0.0071, .loss = 0.05}, with_parts());
    runs::SiteTwin twin(divided.scene, in_step());
    Tap tap(twin.prepared().cell.world());
    runs::StationShot shot = twin.room();
    SiteHistory history;
    Seen seen;
    for (std::int64_t k = 0; k < 1800; ++k) {
      divided.run(tick);
      history.note(*divided.site);
      const runs::StationSide& station = divided.station->side;
      runs::note(station, k, {}, shot);
      if (k % 7 != 0) continue;
      twin.show(shot, tap);
      ASSERT_TRUE(tap.pictures().take());
      const Snapshot& shown = tap.pictures().newest();
      const TickRecord& record = shown.arms.front();
      const runs::SiteState& told = station.site();
      EXPECT_EQ(record.virtual_force.force, told.virtual_force.force);
      EXPECT_EQ(record.gain, station.is_heard() ? told.gain : 0.0);
      EXPECT_EQ((record.status & status::silent_site) != 0U, !station.is_heard());
      EXPECT_EQ(record.lever_torque, station.felt());
      if (!told.is_told) continue;
      const auto at = static_cast<std::size_t>(std::llround(told.time / tick));
      ASSERT_LT(at, history.ticks.size());
      expect_placed_as_told(shown, history.ticks[at], twin.prepared().cell, seen);
      if (HasFailure()) return;
    }
    EXPECT_GT(seen.pictures, 200);
    EXPECT_GT(seen.held, 20);
    EXPECT_GT(seen.late, 100);
    EXPECT_GT(seen.gone, 20);
    for (const runs::PartStepResult& each : divided.site->driven->steps().results()) {
      EXPECT_TRUE(each.was_made) << each.step.phase;
    }
  }
}

TEST(Remote, WithoutItsSiteAStationShowsTheLastPictureAndSaysSo) {
  Divided divided({.delay = 0.02});
  runs::SiteTwin twin(divided.scene, in_step());
  Tap tap(twin.prepared().cell.world());
  runs::StationShot shot = twin.room();
  const auto shown = [&]() -> const Snapshot& {
    runs::note(divided.station->side, 0, {}, shot);
    twin.show(shot, tap);
    (void)tap.pictures().take();
    return tap.pictures().newest();
  };
  divided.run(0.1, true, false);
  const std::vector<double> start = twin.prepared().cell.description().arms.front().start;
  EXPECT_EQ(shown().arms.front().q[1], start[1]) << "the scene as it starts";
  EXPECT_NE(shown().arms.front().status & status::silent_site, 0U);
  divided.run(4.0);
  const TickRecord heard = shown().arms.front();
  // The tool leans on the table: the pair that the site calls the nearest is found here, too.
  ASSERT_EQ(tap.pictures().newest().pair_count, 1);
  const Separation& table = tap.pictures().newest().near().front().separation;
  EXPECT_LT(table.distance, 9e-3);
  EXPECT_NEAR(table.distance, divided.station->side.site().nearest, 1e-6);
  EXPECT_GT(norm(heard.virtual_force.force), 20.0);
  EXPECT_EQ(heard.status & status::silent_site, 0U);
  EXPECT_NE(heard.q[1], start[1]);
  divided.run(1.0, true, false);
  const TickRecord silent = shown().arms.front();
  EXPECT_NE(silent.status & status::silent_site, 0U);
  EXPECT_EQ(silent.gain, 0.0);
  EXPECT_NEAR(silent.q[1], heard.q[1], 0.02);
}

std::vector<double> numbers_of(const network::HandInput& hand) {
  std::vector<double> all;
  network::for_each_field(
      [&all](const network::HandField& /*field*/, const auto& x) {
        if constexpr (std::is_arithmetic_v<std::remove_cvref_t<decltype(x)>>) {
          all.push_back(static_cast<double>(x));
        } else {
          all.insert(all.end(), x.begin(), x.end());
        }
      },
      hand);
  return all;
}
/// Every number of a command; a member that is added does not compile here before it is told.
std::vector<double> numbers_of(const network::Command& command) {
  const auto& [hand, second, sound, silent_for, phase] = command;
  std::vector<double> all = numbers_of(hand);
  const std::vector<double> other = numbers_of(second);
  all.insert(all.end(), other.begin(), other.end());
  all.insert(all.end(), {sound ? 1.0 : 0.0, silent_for, static_cast<double>(phase)});
  return all;
}

/// What one side tells arrives at the other.
void pass(network::RemoteLink& from, network::RemoteLink& to) {
  Relay relay(seed);
  for (network::RemoteLink* link : {&from, &to}) link->prepare(1, tick);
  from.receive(at(1.0));
  from.send(network::Vec<network::any_size>::Zero(1), tick);
  relay.carry(from, to, {.delay = 0.0}, 1.0);
  to.receive(at(1.0));
  ASSERT_TRUE(to.is_linked());
}

TEST(Remote, EveryNumberOfACommandArrives) {
  network::Command told;
  double next = 0.0;
  for (network::HandInput* hand : {&told.hand, &told.second}) {
    network::for_each_field(
        [&next](const network::HandField& /*field*/, auto& x) {
          using Value = std::remove_cvref_t<decltype(x)>;
          if constexpr (std::is_same_v<Value, Vec3>) {
            for (double& each : x) each = next += 0.125;
          } else {
            x = static_cast<Value>((std::is_integral_v<Value> ? 8.0 : 1.0) * (next += 0.125));
          }
        },
        *hand);
  }
  told.silent_for = next + 0.125;
  told.phase = 1000;
  network::RemoteLink station({.session = 1});
  network::RemoteLink site({.session = 2});
  runs::tell(told, station);
  pass(station, site);
  const network::Command heard = runs::heard_command(site);
  EXPECT_EQ(numbers_of(heard), numbers_of(told));
  told.second.lever_rate = std::numeric_limits<double>::quiet_NaN();
  runs::tell(told, station);
  pass(station, site);
  EXPECT_FALSE(runs::heard_command(site).sound);
}

TEST(Remote, EveryNumberOfTheSiteArrives) {
  TickRecord told;
  double next = 0.0;
  for (Vec3* v : {&told.virtual_force.force, &told.virtual_force.torque, &told.coupling.force,
                  &told.coupling.torque, &told.v_WT}) {
    for (double& x : *v) x = next += 0.125;
  }
  for (double& q : told.q) q = next += 0.125;
  for (double* x : {&told.pairs.nearest, &told.time}) *x = next += 0.125;
  told.gain = 0.625;
  told.status = status::saturated | status::hold_lost;
  const Pose turned(Eigen::Translation3d(1.0, 2.0, 3.0) *
                    Eigen::AngleAxisd(2.5, Vec3(1.0, 2.0, -3.0).normalized()));
  runs::PartState part;
  part.part = 7;
  part.where = runs::PartState::Where::is_held;
  part.X = turned.inverse();
  network::RemoteLink station({.session = 1});
  network::RemoteLink site({.session = 2});
  runs::tell(told, turned, part, site);
  pass(site, station);
  const runs::SiteState heard = runs::heard_state(station);
  EXPECT_TRUE(heard.is_told);
  EXPECT_TRUE(heard.X_WT.isApprox(turned, 1e-12));
  EXPECT_EQ(heard.virtual_force.force, told.virtual_force.force);
  EXPECT_EQ(heard.virtual_force.torque, told.virtual_force.torque);
  EXPECT_EQ(heard.coupling.force, told.coupling.force);
  EXPECT_EQ(heard.coupling.torque, told.coupling.torque);
  EXPECT_EQ(heard.v_WT, told.v_WT);
  EXPECT_EQ(heard.q, told.q);
  EXPECT_EQ(heard.gain, told.gain);
  EXPECT_EQ(heard.nearest, told.pairs.nearest);
  EXPECT_EQ(heard.time, told.time);
  EXPECT_EQ(heard.status, told.status);
  EXPECT_EQ(heard.part.part, part.part);
  EXPECT_EQ(heard.part.where, part.where);
  EXPECT_TRUE(heard.part.X.isApprox(part.X, 1e-12));
}

TEST(Remote, ASceneWithoutALineCannotBeDivided) {
  const scene::Scene whole = scene::load(REPEL_SOURCE "/scenes/plates.yaml");
  network::RemoteLink link({.session = 1});
  try {
    (void)runs::prepare(whole, in_step(), nullptr, &link);
    FAIL();
  } catch (const SetupError& error) {
    EXPECT_NE(std::string(error.what()).find("'line'"), std::string::npos) << error.what();
    EXPECT_NE(error.file().find("plates.yaml"), std::string::npos);
  }
}

}  // namespace remote_test
}  // namespace repel::test
