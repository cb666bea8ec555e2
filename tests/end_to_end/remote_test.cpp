// A scene in two programs, in step: the real ones, but for the clock and a path that is simulated.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <repel/scene/scene.hpp>

#include "arm_backend.hpp"
#include "driven_cell.hpp"
#include "network/remote/relay.hpp"
#include "prepared_run.hpp"
#include "station_side.hpp"

namespace repel::test {
namespace remote_test {

constexpr unsigned seed = 1993;
constexpr double tick = 0.0025;

scene::Scene delayed() {
  return scene::load(REPEL_SOURCE "/scenes/delayed.yaml");
}

teleop::RunOptions in_step() {
  teleop::RunOptions options;
  options.fast = true;
  return options;
}

/// The robot's side.
struct Site {
  network::RemoteLink link;
  std::unique_ptr<teleop::PreparedRun> prepared;
  std::unique_ptr<teleop::DrivenCell> driven;
  TickRecord last;

  Site(const scene::Scene& scene, std::uint64_t session) : link({.session = session}) {
    const teleop::RunOptions options = in_step();
    prepared = teleop::prepare(scene, options, nullptr, &link);
    const ArmDescription& arm = prepared->cell.description().arms.front();
    std::vector<std::unique_ptr<TorqueDrivenArm>> arms;
    arms.push_back(teleop::arm_backend("bullet").make(arm.model, arm.start, 0.1, {}));
    std::vector<teleop::OperatorInput> operators;
    operators.emplace_back(network::Script());
    driven = std::make_unique<teleop::DrivenCell>(prepared->cell, prepared->scene, std::move(arms),
                                                  std::move(operators), &link);
  }
  void step(double now) {
    last = *driven->tick(at(now)).front();
    driven->move_arms(tick, 1);
  }
  [[nodiscard]] double speed() const {
    double fastest = 0.0;
    for (const double v : last.v) fastest = std::max(fastest, std::abs(v));
    return fastest;
  }
};

/// The operator's side.
struct Station {
  network::RemoteLink link;
  teleop::StationSide side;

  Station(const scene::Scene& scene, std::uint64_t session)
      : link({.session = session}), side(scene, in_step(), link, nullptr) {}
};

/// Both, the path between them, and what was worst.
struct Divided {
  scene::Scene scene = delayed();
  RelayPath path;
  std::unique_ptr<Site> site;
  std::unique_ptr<Station> station;
  Relay forth{seed}, back{seed + 1};
  double now = 0.0;
  double nearest = 1.0;    ///< [m]
  double fastest = 0.0;    ///< [m/s] of the tool
  double hardest = 0.0;    ///< [N] of the walls
  double strongest = 0.0;  ///< [N m] at the lever

  explicit Divided(const RelayPath& on) : path(on) {
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
    EXPECT_LT(divided.site->speed(), 0.02);
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
    EXPECT_LT(divided.site->speed(), 1e-3);
    EXPECT_NE(divided.site->last.status & status::silent_device, 0U);
    EXPECT_EQ(divided.site->last.gain, 0.0);
    divided.run(2.0, false, true);
    EXPECT_LT(divided.site->speed(), 1e-3);
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

TEST(Remote, ASceneWithoutALineCannotBeDivided) {
  const scene::Scene whole = scene::load(REPEL_SOURCE "/scenes/plates.yaml");
  network::RemoteLink link({.session = 1});
  try {
    (void)teleop::prepare(whole, in_step(), nullptr, &link);
    FAIL();
  } catch (const SetupError& error) {
    EXPECT_NE(std::string(error.what()).find("'line'"), std::string::npos) << error.what();
    EXPECT_NE(error.file().find("plates.yaml"), std::string::npos);
  }
}

}  // namespace remote_test
}  // namespace repel::test
