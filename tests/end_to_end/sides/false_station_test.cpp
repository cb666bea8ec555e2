// SPDX-License-Identifier: BSD-3-Clause
// A site of the real program, in step, and stations that are false: what they send may stop the
// robot, never drive it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

#include <repel/scene/scene.hpp>

#include "end_to_end/program.hpp"
#include "end_to_end/two_sides.hpp"
#include "network/remote/relay.hpp"
#include "support/draws.hpp"
#include "support/families.hpp"

namespace repel::test {
namespace false_station_test {

using network::any_size;
using network::RemotePacket;
using network::Vec;

/// The robot's side, and what a measurement from outside says of it: speed and intrusion from the
/// joint positions of the simulated arm alone.
struct MeasuredSite : Site {
  Vec3 at_W{0, 0, 0};
  bool has_moved = false;
  double fastest = 0.0;  ///< [m/s] of the tool
  double nearest = 1.0;  ///< [m] least distance of a wall, negative inside

  explicit MeasuredSite(const scene::Scene& scene) : Site(scene, 1) {}
  void step(double now) {
    Site::step(now);
    measure();
  }
  void measure() {
    const Vec3 before = at_W;
    at_W = origin(prepared->cell.X_WT(0));
    if (has_moved) fastest = std::max(fastest, (at_W - before).norm() / tick);
    has_moved = true;
    nearest = std::min(nearest, last.pairs.nearest);
  }
};

/// What a false station sends: a packet of its own making in each tick.
struct FalseStation {
  RemotePacket packet;
  network::WaveAccount sent;

  explicit FalseStation(std::uint64_t session) {
    packet.session = session;
    packet.values[0] = 1.0;  // its command is sound
    sent.clear(6);
  }
  /// Posts the packet that tells of one more wave [sqrt(W)].
  void send(const Vec<any_size>& wave, double now, network::RemoteLink& to) {
    sent.add(wave, tick);
    packet.energy_sent = sent.energy;
    std::copy_n(sent.sum.data(), 6, packet.sum.begin());
    post(now, to);
  }
  void post(double now, network::RemoteLink& to) {
    ++packet.sequence;
    packet.sent = std::llround(1e9 * (7e3 + now));
    to.incoming().draft() = packet;
    (void)to.incoming().post();
  }
};

/// A wave along one direction, as a function of time.
using Waves = std::function<Vec<any_size>(double)>;
Vec<any_size> along(const Vec3& direction, double wave) {
  Vec<any_size> six = Vec<any_size>::Zero(6);
  six.head<3>() = wave * direction;
  return six;
}

/// A run of a site with whatever is at the other end.
struct Trial {
  scene::Scene scene;
  MeasuredSite site;
  double now = 0.0;

  explicit Trial(const scene::Scene& of) : scene(of), site(of) {}
  void attack(double seconds, FalseStation& station, const Waves& waves) {
    for (const double until = now + seconds; now < until;) {
      now += tick;
      station.send(waves(now), now, site.link);
      site.step(now);
      drain();
    }
  }
  /// With the script of the scene, over a path without delay.
  void play(double seconds, Station& station) {
    Relay forth(1), back(2);
    for (const double until = now + seconds; now < until;) {
      now += tick;
      site.step(now);
      station.side.tick(at(5e4 + now), tick);
      forth.carry(station.link, site.link, {.delay = 0.0}, now);
      back.carry(site.link, station.link, {.delay = 0.0}, now);
    }
  }
  void drain() {
    while (site.link.outgoing().front() != nullptr) site.link.outgoing().pop();
  }
  [[nodiscard]] double intrusion() const { return std::max(0.0, -site.nearest); }
};

scene::Scene scene_named(const std::string& name) {
  return scene::load(REPEL_SOURCE "/scenes/" + name + ".yaml");
}
/// The scene with walls that give way.
scene::Scene softened(const std::string& name, const std::string& hard, const std::string& soft) {
  std::string text = text_of(REPEL_SOURCE "/scenes/" + name + ".yaml");
  const std::size_t at = text.find(hard);
  if (at == std::string::npos) throw std::runtime_error("no '" + hard + "' in " + name);
  text.replace(at, hard.size(), soft);
  return scene::parse(text, REPEL_SOURCE "/scenes/" + name + ".yaml");
}

/// The deepest that the scene's own script comes into its walls [m].
double depth_of_script(const scene::Scene& scene) {
  Trial run(scene);
  Station station(scene, 2);
  run.play(14.0, station);
  EXPECT_GT(run.site.link.counts().received, 1000);
  EXPECT_EQ(run.site.link.counts().beyond, 0);
  EXPECT_EQ(run.site.link.counts().closed, 0);
  EXPECT_LT(run.site.fastest, 0.25);
  return run.intrusion();
}

struct Attack {
  std::string name;
  Waves waves;
};
constexpr double turn = 2.0 * std::numbers::pi;
constexpr unsigned seed = 1701;

Attack constant(const Vec3& direction, double u) {
  return {"constant " + std::to_string(u), [=](double) { return along(direction, u); }};
}
/// Of any shape, size and direction; half of them within what a sound station sends.
Attack drawn(families::Rng& rng) {
  Vec3 direction = Vec3::Zero();
  while (direction.norm() < 0.1) {
    for (double& x : direction) x = families::uniform(rng, -1.0, 1.0);
  }
  direction.normalize();
  const double u = std::pow(10.0, families::uniform(rng, -0.3, 3.0));
  const double f = std::pow(10.0, families::uniform(rng, -0.5, 1.5));
  const double twist = families::uniform(rng, 0.0, 1.0) < 0.3 ? 0.2 * u : 0.0;
  const auto wave = [=](double share) {
    Vec<any_size> six = along(direction, share * u);
    six.tail<3>().setConstant(twist * share);
    return six;
  };
  const std::string of = std::to_string(u) + " sqrt(W), " + std::to_string(f) + " Hz";
  switch (rng() % 6) {
    case 0:
      return {"constant " + of, [=](double) { return wave(1.0); }};
    case 1:
      return {"a step of " + of, [=](double t) { return wave(t < 1.0 ? 0.0 : 1.0); }};
    case 2:
      return {"a sine of " + of, [=](double t) { return wave(std::sin(turn * f * t)); }};
    case 3:
      return {"a square of " + of,
              [=](double t) { return wave(std::sin(turn * f * t) > 0.0 ? 1.0 : -1.0); }};
    case 4:
      return {"bursts of " + of,
              [=](double t) { return wave(std::fmod(f * t, 1.0) < 0.1 ? 1.0 : 0.0); }};
    default:
      return {"round and round, " + of, [=](double t) {
                return along({std::cos(turn * f * t), std::sin(turn * f * t), 0.0}, u);
              }};
  }
}
/// Down onto the table, into the corner of walls, and up, where nothing is; then any.
std::vector<Attack> attacks() {
  std::vector<Attack> all;
  for (const Vec3& direction : {Vec3(0, 0, -1), Vec3(1, 1, -1), Vec3(0, 0, 1)}) {
    for (const double u : {2.0, 4.0, 50.0, 1000.0}) {
      all.push_back(constant(direction.normalized(), u));
    }
  }
  families::Rng rng(seed);
  for (int i = families::draws(20); i > 0; --i) all.push_back(drawn(rng));
  return all;
}

struct Worst {
  double fastest = 0.0, intrusion = 0.0;
};
Worst worst_of(const scene::Scene& scene) {
  Worst worst;
  for (const Attack& attack : attacks()) {
    SCOPED_TRACE(attack.name + ", seed " + std::to_string(seed));
    Trial run(scene);
    FalseStation station(9);
    run.attack(3.0, station, attack.waves);
    EXPECT_LE(run.site.fastest, 0.27);
    worst.fastest = std::max(worst.fastest, run.site.fastest);
    worst.intrusion = std::max(worst.intrusion, run.intrusion());
  }
  return worst;
}

TEST(FalseStation, DrivesTheToolNoFasterThanItsSpeedAndNoDeeperThanTheScript) {
  for (const char* const name : {"remote", "delayed"}) {
    SCOPED_TRACE(name);
    const scene::Scene scene = scene_named(name);
    const double depth = depth_of_script(scene);
    const Worst worst = worst_of(scene);
    EXPECT_LE(worst.intrusion, depth + 1e-6);
    EXPECT_GT(worst.fastest, 0.2) << "within its bounds it drives the tool";
  }
}

TEST(FalseStation, DrivesTheToolNotThroughASoftWall) {
  const scene::Scene scene = softened("remote", "surface_force: 200 N", "surface_force: 60 N");
  const Worst worst = worst_of(scene);
  EXPECT_EQ(worst.intrusion, 0.0);
}

// The false one sends in every tick, and first.
TEST(FalseStation, IsClosedAndASoundOneIsHeardAtOnce) {
  for (const double u : {50.0, 1000.0, 1e155}) {
    SCOPED_TRACE(u);
    Trial run(scene_named("delayed"));
    FalseStation wrong(9);
    Station sound(run.scene, 2);
    Relay forth(1), back(2);
    double heard_at = -1.0;
    while (run.now < 9.0) {
      run.now += tick;
      wrong.send(along({0, 0, -1}, u), run.now, run.site.link);
      run.site.step(run.now);
      sound.side.tick(at(5e4 + run.now), tick);
      forth.carry(sound.link, run.site.link, {.delay = 0.0}, run.now);
      back.carry(run.site.link, sound.link, {.delay = 0.0}, run.now);
      if (heard_at < 0.0 && sound.link.partner_played() > 0.0) heard_at = run.now;
    }
    EXPECT_GT(heard_at, 0.0);
    EXPECT_LT(heard_at, 1.0) << "s until its script moved the tool";
    EXPECT_LE(run.site.fastest, 0.27);
    EXPECT_EQ(run.intrusion(), 0.0);
    // Its script has leant on the table.
    EXPECT_GT(norm(run.site.last.virtual_force.force), 10.0);
    EXPECT_EQ(run.site.last.status & status::failsafe, 0U);
  }
}

TEST(FalseStation, NoNumberThatItSendsStaysInTheRobot) {
  const double huge = 1e300, none = std::numeric_limits<double>::quiet_NaN();
  const auto spoil = [&](int kind, RemotePacket& packet) {
    switch (kind) {
      case 0:
        packet.energy_sent = huge;
        for (double& x : packet.sum) x = 1e308;
        break;
      case 1:
        packet.sum[2] = none;
        break;
      case 2:
        packet.sum[2] = -1e6;
        break;
      case 3:  // every number of its command
        for (double& x : packet.values) x = huge;
        packet.values[0] = 1.0;
        break;
      case 4:
        for (double& x : packet.values) x = -huge;
        packet.values[0] = 1.0;
        break;
      default:
        packet.heard = 1;
        packet.heard_sent = packet.heard_for = std::numeric_limits<std::int64_t>::max();
        packet.energy_played = huge;
    }
  };
  for (int kind = 0; kind < 6; ++kind) {
    SCOPED_TRACE("kind " + std::to_string(kind));
    Trial run(scene_named("delayed"));
    FalseStation wrong(9);
    run.attack(0.5, wrong, [](double) { return along({0, 0, -1}, 1.0); });
    for (int i = 0; i < 400; ++i) {
      run.now += tick;
      const RemotePacket before = wrong.packet;
      spoil(kind, wrong.packet);
      wrong.post(run.now, run.site.link);
      const RemotePacket& now = wrong.packet;
      std::tie(wrong.packet.sum, wrong.packet.values, wrong.packet.energy_sent) =
          std::tie(before.sum, before.values, before.energy_sent);
      EXPECT_GT(now.sequence, 0);
      run.site.step(run.now);
      run.drain();
      for (const double torque : run.site.last.torques) ASSERT_TRUE(std::isfinite(torque));
    }
    EXPECT_LE(run.site.fastest, 0.27);
    Station sound(run.scene, 2);
    run.play(7.0, sound);
    EXPECT_GT(norm(run.site.last.virtual_force.force), 10.0) << "its script leans on the table";
    EXPECT_EQ(run.site.last.status & status::failsafe, 0U);
    EXPECT_LE(run.site.fastest, 0.27);
    EXPECT_EQ(run.intrusion(), 0.0);
  }
}

TEST(FalseSite, ShowsNoMoreThanTheWholeForce) {
  for (const double told : {1e300, -1e300, 2.0, -1.0}) {
    network::RemoteLink site({.session = 1}), station({.session = 2});
    for (network::RemoteLink* link : {&site, &station}) link->prepare(1, tick);
    TickRecord record;
    record.gain = told;
    record.pairs.nearest = 1.0;
    runs::tell(record, Pose::Identity(), {}, site);
    site.receive(at(1.0));
    site.send(Vec<any_size>::Zero(1), tick);
    Relay relay(1);
    relay.carry(site, station, {.delay = 0.0}, 1.0);
    station.receive(at(1.0));
    ASSERT_TRUE(runs::heard_state(station).is_told);
    EXPECT_EQ(runs::heard_state(station).gain, told > 0.0 ? 1.0 : 0.0);
  }
}

}  // namespace false_station_test
}  // namespace repel::test
