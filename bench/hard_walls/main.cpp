// SPDX-License-Identifier: BSD-3-Clause
// How deep hands that push at random get into the walls of the shipped scenes, what holds them off,
// and what it costs.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <repel/cell/arm_port.hpp>
#include <repel/cell/cell.hpp>
#include <repel/cell/layout.hpp>
#include <repel/common/deadline.hpp>
#include <repel/loop/hard_contacts.hpp>
#include <repel/loop/tick.hpp>
#include <repel/network/modules.hpp>
#include <repel/reduction/shape.hpp>
#include <repel/scene/scene.hpp>
#include <repel/simulated/delayed_arm.hpp>
#include <repel/world/kinematics.hpp>

#include "../parts.hpp"
#include "arm_backend.hpp"
#include "chatter.hpp"
#include "command_line.hpp"
#include "describe.hpp"
#include "servoed_arm.hpp"

namespace {

using namespace repel;
using std::chrono::nanoseconds;

constexpr double stronger_than_the_arm = 1e4;  // [N] of a hand: nothing in its network gives way

/// @param most [N] and [N m] of the hand
network::Plan hand_of(const ArmModel& arm, double most) {
  std::vector<network::JointRange> ranges;
  for (const ArmLink& link : arm.links) ranges.push_back({link.lower, link.upper});
  return network::Plan()
      .add("torque_arm", network::TorqueArm())
      .add("multiplex", network::Multiplex())
      .add("spaceball", network::Spaceball(
                            {.saturation = 10.0, .angular_saturation = 10.0, .time_constant = 0.0}))
      .add("kbb2", network::Kbb2({.stiffness = 5000.0,
                                  .damping = 250.0,
                                  .force_limit = most,
                                  .angular_stiffness = 150.0,
                                  .angular_damping = 8.0,
                                  .torque_limit = most}))
      .add("obstacle", network::Obstacle())
      .add("puma_kin", network::PumaKin())
      .add("arm_obstacle", network::ArmObstacle())
      .add("limits", network::Limits({}, ranges))
      .add("puma_joints", network::PumaJoints(static_cast<int>(arm.links.size())));
}

/// A hand that goes another way, at another speed, every third of a second.
class RandomHand {
 public:
  RandomHand(std::uint64_t seed, double speed) : random_(seed), speed_(speed) {}
  const network::Command& step(double period) {
    left_ -= period;
    if (left_ <= 0.0) {
      left_ = 0.3 * (0.5 + std::abs(draw()));
      command_.hand.ball.linear = speed_ * Vec3(draw(), draw(), draw());
      command_.hand.ball.angular = 3.0 * speed_ * Vec3(draw(), draw(), draw());
    }
    return command_;
  }

 private:
  double draw() { return std::uniform_real_distribution<double>(-1.0, 1.0)(random_); }
  std::mt19937_64 random_;
  double speed_;
  double left_ = 0.0;
  network::Command command_;
};

enum class Way { springs, hard, hard_alone, velocity_damper, barrier_function, stopping_distance };

const char* text_of(Way way) {
  constexpr const char* names[] = {
      "springs",          "hard", "hard, weak springs", "velocity damper", "barrier function",
      "stopping distance"};
  return names[static_cast<std::size_t>(way)];
}
bool is_hard(Way way) {
  return way == Way::hard || way == Way::hard_alone;
}

struct Setting {
  std::string scene;
  double rate = 400.0;  // [Hz]
  Way way = Way::hard;
  double inertia = 1.0;  // of the simulated arm, as a multiple of its model's
  int delay = 0;         // [ticks] of its drive
  double wrist = 0.0;  // [kg m^2] of the last link, which then has no friction; 0: as in the scene
  double hand = stronger_than_the_arm;  // [N]
  double hand_speed = 0.6;              // [m/s] along each axis
  double hand_until = 1e9;              // [s] after which it rests
};

struct Outcome {
  double deepest = 0.0;                 // [m] into a wall
  double tool = 0.0;                    // [m] the same, of tools alone
  double withstood = 0.0;               // [N]
  double way = 0.0;                     // [m] that the tools moved
  std::int64_t lost = 0;                // ticks
  std::optional<std::int64_t> told;     // first tick in which a wall was said to be lost
  std::optional<std::int64_t> entered;  // first tick in which a wall was entered by the bound
  DurationHistogram compute;
  double sampling_energy = 0.0;  // [J] most
  double fastest_joint = 0.0;    // [rad/s]
  double chatter = 0.0;          // [N m] rms of the last joint, while the hand rests
  Status said = 0;               // in some tick
  [[nodiscard]] bool is_untold() const { return entered && !(told && *told < *entered); }
};

void lighten(ArmLink& link, double inertia) {
  link.mass = 0.01;
  link.p_LC = Vec3(0, 0, 0.01);
  link.I_C_L = inertia * Mat3::Identity();
  link.rotor_inertia = link.viscous_friction = link.coulomb_friction = 0.0;
}

/// The cell of a scene, with this hand and these walls.
teleop::DescribedScene described(const Setting& setting, const scene::Scene& scene, bool hard) {
  teleop::DescribedScene described = teleop::describe(scene, setting.rate, true);
  const auto change = [&](ForceLaw& law) {
    if (law.passable) return;
    if (setting.way == Way::hard_alone) law.surface_force *= 0.02;
    law.damping_may_rise = true;
    law.hold = hard ? HoldKind::hard : HoldKind::soft;
  };
  for (ObstacleDescription& obstacle : described.cell.obstacles) change(obstacle.law);
  for (std::size_t i = 0; i < described.cell.arms.size(); ++i) {
    ArmDescription& arm = described.cell.arms[i];
    if (setting.wrist > 0.0) {
      lighten(arm.model.links.back(), setting.wrist);
      lighten(described.robots[i].arm.links.back(), setting.wrist);
      arm.kinematics = std::make_unique<Kinematics>(arm.model);
    }
    change(arm.law);
    if (arm.self_law) change(*arm.self_law);
    arm.network = hand_of(arm.model, setting.hand);
    arm.options.drive_delay += setting.delay;
  }
  described.cell.gain_check = network::GainCheck::warning;
  described.cell.loose.clear();
  return described;
}

/// What others do to hold a tool off: the commanded twist is changed before it is followed. Gaps
/// are those of a second cell at the same poses.
class CommandFilter {
 public:
  CommandFilter(const Setting& setting, CellDescription description)
      : way_(setting.way), cell_(std::move(description)) {
    std::vector<BodyId> tools;
    for (std::size_t i = 0; i < cell_.arms(); ++i) tools.push_back(cell_.layout(i).tool);
    contacts_.emplace(cell_.world(), tools);
  }
  void sense(std::span<const ArmReadings> readings, nanoseconds now) {
    cell_.sense(readings, now);
    contacts_->collect(cell_.coprocessor(), 0.2);
    (void)cell_.act({});
  }
  void filter(std::size_t arm, Twist& V) const {
    const BodyId tool = cell_.layout(arm).tool;
    double share = 1.0;
    for (int sweep = 0; sweep < 10; ++sweep) {
      for (const HardContact& contact : contacts_->all()) {
        if (contact.a != tool && contact.b != tool) continue;
        const Wrench& on_tool = contact.a == tool ? contact.on_a : contact.on_b;
        const double rate = power(on_tool, V);
        const double missing = -allowed(contact.gap) - rate;
        if (missing <= 0.0) continue;
        if (way_ == Way::stopping_distance) {
          share = std::min(share, allowed(contact.gap) / -rate);
          continue;
        }
        // The smallest change, where 1 rad counts as 0.1 m.
        const double turn = 100.0;
        const double per = squared_norm(on_tool.force) + turn * squared_norm(on_tool.torque);
        V.linear += missing / per * on_tool.force;
        V.angular += missing / per * turn * on_tool.torque;
      }
    }
    V = share * V;
  }

 private:
  // [m/s]
  [[nodiscard]] double allowed(double gap) const {
    const double d = std::max(0.0, gap - 2e-3);
    switch (way_) {
      case Way::velocity_damper:  // Faverjon, Tournassoud 1987, from 50 mm on
        return d < 0.05 ? 0.5 * d / 0.05 : 1e9;
      case Way::barrier_function:  // Ames et al. 2017, dd/dt >= -gamma d with gamma = 5 / s
        return 5.0 * d;
      default:  // speed and separation: it stops at 2 m/s^2 after 50 ms
        return std::sqrt(0.01 + 4.0 * d) - 0.1;
    }
  }
  Way way_;
  Cell cell_;
  std::optional<HardContacts> contacts_;
};

/// The simulated arms of a cell, and what moves them.
struct Driven {
  Driven(const Setting& setting, const scene::Scene& scene, const teleop::DescribedScene& described,
         std::uint64_t seed) {
    for (std::size_t i = 0; i < described.cell.arms.size(); ++i) {
      const ArmDescription& arm = described.cell.arms[i];
      const ArmModel& model = described.robots[i].arm;
      ArmModel plant = model;
      for (ArmLink& link : plant.links) {
        link.mass *= setting.inertia;
        link.I_C_L = setting.inertia * link.I_C_L;
        link.rotor_inertia *= setting.inertia;
      }
      arms.push_back(teleop::arm_backend("bullet").make(plant, arm.start, 0.1, {}));
      if (setting.delay > 0) {
        arms.back() =
            std::make_unique<DelayedArm>(std::move(arms.back()), plant.links.size(), setting.delay);
      }
      if (const auto& admittance = scene.arm_setup(i).robot.admittance) {
        arms.back() = std::make_unique<teleop::ServoedArm>(
            std::move(arms.back()), model, arm.model, admittance->response, 1.0 / setting.rate);
      }
      ports.emplace_back(*arms.back(), plant.links.size());
      hands.emplace_back(seed + 1000 * hands.size(), setting.hand_speed);
    }
    readings.resize(arms.size());
    commands.resize(arms.size());
  }
  std::vector<std::unique_ptr<TorqueDrivenArm>> arms;
  std::vector<ArmPort> ports;
  std::vector<RandomHand> hands;
  std::vector<ArmReadings> readings;
  std::vector<network::Command> commands;
};

constexpr double bound = 1e-4;  // [m] to which a hard wall may be entered

void note_pairs(const Cell& cell, Outcome& outcome) {
  for (std::int32_t i = 0; i < static_cast<std::int32_t>(cell.world().pairs().size()); ++i) {
    const Pair& pair = cell.world().pair({i});
    if (pair.law.passable) continue;
    const double deepest = cell.coprocessor().extremes_of({i}).deepest;
    outcome.deepest = std::max(outcome.deepest, deepest);
    const BodyId body = cell.world().part(pair.a).body;
    const bool is_fixed = cell.world().part(pair.b).body == World::fixed;
    for (std::size_t k = 0; k < cell.arms(); ++k) {
      if (is_fixed && body == cell.layout(k).tool) outcome.tool = std::max(outcome.tool, deepest);
    }
    outcome.withstood = std::max(outcome.withstood, cell.withstood({i}));
  }
}

void note_motion(const Cell& cell, std::size_t arm, const TickRecord& record, Outcome& outcome) {
  outcome.said |= record.status;
  const auto* joints = cell.network(arm).find<network::PumaJoints>();
  outcome.sampling_energy = std::max(outcome.sampling_energy, joints->sampling_energy());
  for (const double rate : record.v_read) {
    outcome.fastest_joint = std::max(outcome.fastest_joint, std::abs(rate));
  }
}

Outcome push(const Setting& setting, std::int64_t ticks, std::uint64_t seed,
             std::vector<ObstacleDescription> obstacles = {}) {
  const scene::Scene scene = scene::load(REPEL_SOURCE "/scenes/" + setting.scene + ".yaml");
  teleop::DescribedScene set_up = described(setting, scene, is_hard(setting.way));
  if (!obstacles.empty()) set_up.cell.obstacles = std::move(obstacles);
  Driven driven(setting, scene, set_up, seed);
  Cell cell(std::move(set_up.cell));
  std::optional<CommandFilter> filter;
  if (!is_hard(setting.way) && setting.way != Way::springs) {
    filter.emplace(setting, described(setting, scene, true).cell);
  }
  Outcome outcome;
  std::vector<teleop::ChatterMeter> meters;
  for (std::size_t i = 0; i < cell.arms(); ++i) {
    meters.emplace_back(1, setting.rate);
  }
  nanoseconds now{0};
  for (std::int64_t tick = 0; tick < ticks; ++tick) {
    now += cell.period();
    for (std::size_t i = 0; i < cell.arms(); ++i) {
      driven.readings[i] = driven.ports[i].read();
      driven.commands[i] = driven.hands[i].step(1.0 / setting.rate);
      if (static_cast<double>(tick) > setting.hand_until * setting.rate) {
        driven.commands[i].hand.ball = {};
      }
    }
    if (filter) {
      filter->sense(driven.readings, now);
      for (std::size_t i = 0; i < cell.arms(); ++i) {
        filter->filter(i, driven.commands[i].hand.ball);
      }
    }
    const auto begin = std::chrono::steady_clock::now();
    cell.sense(driven.readings, now);
    const auto records = cell.act(driven.commands);
    outcome.compute.record(std::chrono::steady_clock::now() - begin);
    for (std::size_t i = 0; i < cell.arms(); ++i) {
      const bool is_lost = (records[i]->status & status::hold_lost) != 0U;
      outcome.lost += is_lost ? 1 : 0;
      if (is_lost && !outcome.told) outcome.told = tick;
      if (records[i]->pairs.nearest < -bound && !outcome.entered) outcome.entered = tick;
      outcome.way += records[i]->v_WT.norm() / setting.rate;
      note_motion(cell, i, *records[i], outcome);
      // What swings out at the end of the motion is none.
      if (static_cast<double>(tick) > (setting.hand_until + 1.0) * setting.rate) {
        const std::size_t last = driven.readings[i].q.size() - 1;
        meters[i].add(std::span(records[i]->torques).subspan(last, 1));
      }
      driven.ports[i].apply(*records[i]);
      driven.arms[i]->step(1.0 / setting.rate);
    }
  }
  note_pairs(cell, outcome);
  for (const teleop::ChatterMeter& meter : meters) {
    const double rms = meter.of(0).rms;
    if (rms > outcome.chatter) outcome.chatter = rms;
  }
  return outcome;
}

/// [Hz] Up to which a scene can run: an arm may answer up to 100 ticks late.
double fastest(const std::string& name) {
  const scene::Scene scene = scene::load(REPEL_SOURCE "/scenes/" + name + ".yaml");
  const auto& admittance = scene.robot.admittance;
  return admittance ? std::min(4000.0, 100.0 / admittance->response) : 4000.0;
}

double rounded(double value, double step) {
  return std::round(value / step) * step;
}

const std::vector<std::string>& scenes() {
  static const std::vector<std::string> all{
      "anderson_4x8", "waste_sorting", "storage_tank", "glove_box",      "plates",      "two_arms",
      "conveyor",     "peg_fixture",   "soft_tissue",  "glove_box_mesh", "bin_picking", "delayed",
      "remote",       "six_axes",      "seen",         "follow_a_seam",  "admittance"};
  return all;
}

bench::Result pushes(const bench::Options& options) {
  bench::Result result;
  result.title = "Random pushes by a hand that is stronger than the arm";
  result.columns = {"scene",
                    "rate [Hz]",
                    "ticks",
                    "springs: deepest [mm]",
                    "hard: deepest [mm]",
                    "hard, weak springs: deepest [mm]",
                    "hardest push withstood [N]",
                    "told as lost [ticks]",
                    "springs: tick p50 [us]",
                    "hard: tick p50 [us]",
                    "hard: tick p99 [us]"};
  const std::vector<double> rates = options.quick
                                        ? std::vector<double>{400.0}
                                        : std::vector<double>{200.0, 400.0, 1000.0, 4000.0};
  const std::int64_t ticks = options.quick ? 800 : 32000;
  const std::size_t count = options.quick ? 2 : scenes().size();
  for (std::size_t s = 0; s < count; ++s) {
    for (const double rate : rates) {
      if (rate > fastest(scenes()[s])) continue;
      const auto run = [&](Way way) {
        return push({.scene = scenes()[s], .rate = rate, .way = way}, ticks, options.seed);
      };
      const Outcome springs = run(Way::springs);
      const Outcome hard = run(Way::hard);
      const Outcome alone = run(Way::hard_alone);
      const std::string row = scenes()[s] + " at " + std::to_string(std::lround(rate)) + " Hz";
      if (hard.deepest > bound) result.fail(row, "a hard wall was entered");
      result.rows.push_back({scenes()[s], rate, ticks, rounded(1e3 * springs.deepest, 1e-3),
                             rounded(1e3 * hard.deepest, 1e-3), rounded(1e3 * alone.deepest, 1e-3),
                             std::round(std::max(hard.withstood, alone.withstood)),
                             hard.lost + alone.lost,
                             rounded(springs.compute.percentile_us(0.5), 0.1),
                             rounded(hard.compute.percentile_us(0.5), 0.1),
                             rounded(hard.compute.percentile_us(0.99), 0.1)});
      bench::progress("pushes", result.rows.size(), count * rates.size());
    }
  }
  result.notes = {
      "A row fails where a hard wall is entered by more than 0.1 mm, by the proven bound of the "
      "distance at each evaluation.",
      "The hand moves at up to 0.6 m/s and 1.8 rad/s along each axis, another way every third of a "
      "second; its coupling gives up to 10 kN. Arms are simulated by Bullet.",
      "With weak springs, their forces are 2 % of those of the scene. What can come and go, or is "
      "only seen by a camera, is left out. The arm of `admittance` takes positions and answers 40 "
      "ms "
      "late, which is too late at 4 kHz.",
      "Ticks told as lost are those in which the arm, braked with all it has, would by its model "
      "have come to rest behind the wall."};
  return result;
}

bench::Result ways(const bench::Options& options) {
  bench::Result result;
  result.title = "Ways to hold a tool off, with the same hands, at 400 Hz";
  result.columns = {"scene",
                    "way",
                    "inertia of the arm / model",
                    "deepest, tool [mm]",
                    "deepest, whole arm [mm]",
                    "tools moved [m]"};
  const std::int64_t ticks = options.quick ? 800 : 32000;
  const std::size_t count = options.quick ? 1 : 4;
  const std::vector<double> inertias =
      options.quick ? std::vector<double>{1.0} : std::vector<double>{1.0, 0.6, 1.6};
  for (std::size_t s = 0; s < count; ++s) {
    for (const double inertia : inertias) {
      for (const Way way : {Way::springs, Way::velocity_damper, Way::barrier_function,
                            Way::stopping_distance, Way::hard}) {
        const Setting setting{scenes()[s], 400.0, way, inertia};
        const Outcome outcome = push(setting, ticks, options.seed);
        if (way == Way::hard && outcome.deepest > bound) {
          result.fail(scenes()[s], "a hard wall was entered");
        }
        result.rows.push_back({scenes()[s], text_of(way), inertia,
                               rounded(1e3 * outcome.tool, 1e-3),
                               rounded(1e3 * outcome.deepest, 1e-3), rounded(outcome.way, 0.01)});
        bench::progress("ways", result.rows.size(), 5 * count * inertias.size());
      }
    }
  }
  result.notes = {
      "All have the springs of the scene. The three published ways change the twist that the hand "
      "commands, by the gaps of the tool: a velocity damper from 50 mm on, a barrier function of "
      "first order with 5 / s, and a scaling of the whole twist to what stops at 2 m/s^2 after 50 "
      "ms; each keeps 2 mm. They do not look at links, nor at torques."};
  return result;
}

/// A shape and where it is.
struct Posed {
  Shape shape;
  Pose X_W;
  /// [m] How far it reaches along the unit `d`, from the origin of the world.
  [[nodiscard]] double extent(const Vec3& d) const {
    const Level& level = shape.level(0);
    return d.dot(X_W * to_vec3(level.core.support(rotate_transposed(X_W, Vec<double>(d))).p)) +
           level.depth;
  }
};

/// Walls of a random kind around a tool, for one arm to be pushed into.
class RandomWalls {
 public:
  explicit RandomWalls(std::uint64_t seed) : random_(seed) {}

  /// @param tool its parts at the start @param kind receives the name of the kind
  std::vector<ObstacleDescription> around(std::span<const Posed> tool, std::string& kind) {
    constexpr const char* kinds[] = {"boxes", "hulls", "slot", "blades", "pegs", "crates"};
    const auto which = static_cast<std::size_t>(pick(6));
    kind = kinds[which];
    std::vector<ObstacleDescription> walls;
    if (which == 2 || which == 5) {  // the tool is between two walls
      const Vec3 d = direction();
      const double half = which == 2 ? 0.2 : 0.05;
      const double gap = which == 2 ? draw(1e-3, 6e-3) : draw(0.03, 0.1);
      const double way = which == 2 ? 0.0 : gap - draw(2e-3, 2e-2);
      for (const double side : {1.0, -1.0}) {
        walls.push_back(before(tool, Shape::box({half, half, 0.01}), side * d, d, gap));
        if (which == 5) walls.back().motion = ReciprocatingMotion{-side * way * d, way / 0.05};
      }
      return walls;
    }
    for (int i = 0; i < 4; ++i) {
      walls.push_back(before(tool, shape(which), direction(), direction(), draw(5e-3, 0.1)));
    }
    return walls;
  }
  double draw(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  int pick(int of) { return std::uniform_int_distribution<int>(0, of - 1)(random_); }

 private:
  Vec3 direction() {
    std::normal_distribution<double> normal;
    return Vec3(normal(random_), normal(random_), normal(random_)).normalized();
  }
  Shape shape(std::size_t which) {
    switch (which) {
      case 0:
        return Shape::box({draw(0.02, 0.1), draw(0.02, 0.1), draw(0.02, 0.1)});
      case 1: {
        std::vector<Vec3> points;
        const Vec3 axes(draw(0.03, 0.12), draw(0.03, 0.12), draw(0.03, 0.12));
        for (int k = 0; k < 150; ++k) points.emplace_back(axes.cwiseProduct(direction()));
        return Shape::hull(points);
      }
      case 3:
        return Shape::box({draw(0.05, 0.2), draw(0.05, 0.2), 0.001});
      default:
        return Shape::cylinder(draw(0.003, 0.02), draw(0.05, 0.2));
    }
  }
  // A wall with its z axis along `z`, so far from all parts of the tool along `d`.
  static ObstacleDescription before(std::span<const Posed> tool, Shape shape, const Vec3& d,
                                    const Vec3& z, double gap) {
    Posed wall{shape, Pose::Identity()};
    wall.X_W.linear() = Eigen::Quaterniond::FromTwoVectors(Vec3(0, 0, 1), z).toRotationMatrix();
    Vec3 middle(0, 0, 0);
    double most = -1e9;
    for (const Posed& part : tool) {
      most = std::max(most, part.extent(d));
      middle += origin(part.X_W) / static_cast<double>(tool.size());
    }
    const double along = most + wall.extent(-d) + gap;
    wall.X_W.translation() = middle + (along - d.dot(middle)) * d;
    ForceLaw law;
    law.range = 0.02;
    law.surface_force = 2.0;
    law.damping_may_rise = true;
    law.hold = HoldKind::hard;
    return {"", std::move(shape), wall.X_W, law};
  }
  std::mt19937_64 random_;
};

/// A scene whose arm stands free among random walls; null where none was found.
std::vector<ObstacleDescription> free_walls(const Setting& setting, RandomWalls& random,
                                            std::string& kind) {
  const scene::Scene scene = scene::load(REPEL_SOURCE "/scenes/" + setting.scene + ".yaml");
  teleop::DescribedScene probe = described(setting, scene, true);
  const Cell cell(std::move(probe.cell));
  const World& world = cell.world();
  std::vector<Posed> tool;
  for (const Part& part : world.parts()) {
    if (part.body != cell.layout(0).tool) continue;
    const BodyState& body = world.motion().bodies[static_cast<std::size_t>(part.body.index)];
    tool.push_back({part.shape, body.X_WB * part.X_BP});
  }
  for (int attempt = 0; attempt < 50; ++attempt) {
    std::vector<ObstacleDescription> walls = random.around(tool, kind);
    for (std::size_t i = 0; i < walls.size(); ++i) walls[i].name = kind + std::to_string(i);
    teleop::DescribedScene tried = described(setting, scene, true);
    tried.cell.obstacles = walls;
    try {
      const Cell with(std::move(tried.cell));
      return walls;
    } catch (const SetupError&) {
      continue;  // the arm starts in one of them
    }
  }
  return {};
}

bench::Result attacks(const bench::Options& options) {
  bench::Result result;
  result.title = "Random walls, arms and hands";
  result.columns = {"seed",
                    "arm of",
                    "walls",
                    "rate [Hz]",
                    "inertia of the arm / model",
                    "delay of the drive [ticks]",
                    "deepest [mm]",
                    "told as lost [ticks]",
                    "entered untold",
                    "push withstood [N]"};
  constexpr const char* arms[] = {"anderson_4x8", "plates", "six_axes", "two_arms"};
  constexpr double rates[] = {200.0, 400.0, 1000.0, 4000.0};
  const std::uint64_t count = options.quick ? 4 : 200;
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::uint64_t seed = options.seed * 1000 + i;
    RandomWalls random(seed);
    Setting setting;
    setting.scene = arms[random.pick(4)];
    setting.rate = rates[random.pick(4)];
    setting.inertia = random.draw(0.6, 1.7);
    setting.delay = random.pick(4);
    std::string kind;
    std::vector<ObstacleDescription> walls = free_walls(setting, random, kind);
    if (walls.empty()) continue;
    const auto ticks = static_cast<std::int64_t>((options.quick ? 2.0 : 8.0) * setting.rate);
    const Outcome outcome = push(setting, ticks, seed, std::move(walls));
    if (outcome.is_untold()) {
      result.fail("seed " + std::to_string(seed), "a hard wall was entered without a word");
    }
    result.rows.push_back({seed, setting.scene, kind, setting.rate, rounded(setting.inertia, 0.01),
                           setting.delay, rounded(1e3 * outcome.deepest, 1e-3), outcome.lost,
                           outcome.is_untold(), std::round(outcome.withstood)});
    bench::progress("attacks", i + 1, count);
  }
  result.notes = {
      "The springs of the walls give 2 N at the surface. A slot is 1 to 6 mm from the tool on "
      "either side; hulls have 150 corners; crates come from both sides at up to 0.16 m/s and "
      "leave 2 "
      "to 20 mm.",
      "A row fails where a wall is entered by more than 0.1 mm, and no tick before said that it "
      "would be."};
  return result;
}

// Light joints, late drives, and a hand beyond the speed limit of the tool.
bench::Result limits(const bench::Options& options) {
  bench::Result result;
  result.title = "Light wrists, late drives and fast hands before soft walls";
  result.columns = {"seed",
                    "arm of",
                    "rate [Hz]",
                    "inertia of the arm / model",
                    "delay of the drive [ticks]",
                    "last link [kg m^2]",
                    "hand [N]",
                    "hand [m/s]",
                    "most gained by sampling [J]",
                    "fastest joint [rad/s]",
                    "chatter of the last joint [N m rms]",
                    "deepest [mm]",
                    "said"};
  constexpr const char* arms[] = {"anderson_4x8", "plates", "six_axes", "glove_box"};
  constexpr double rates[] = {200.0, 400.0, 1000.0, 4000.0};
  const std::uint64_t count = options.quick ? 2 : 100;
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::uint64_t seed = options.seed * 1000 + i;
    RandomWalls random(seed);
    Setting setting;
    setting.way = Way::springs;
    setting.scene = arms[random.pick(4)];
    setting.rate = rates[random.pick(4)];
    setting.inertia = random.pick(2) == 0 ? 1.0 : random.draw(0.6, 1.7);
    setting.delay = random.pick(4);
    setting.wrist = random.pick(4) == 0 ? 0.0 : 2e-5 * std::pow(50.0, random.draw(0.0, 1.0));
    setting.hand = 60.0;
    setting.hand_speed = random.draw(0.1, 0.6);
    setting.hand_until = options.quick ? 1.0 : 5.0;
    const auto ticks = static_cast<std::int64_t>((setting.hand_until + 2.0) * setting.rate);

    const Outcome outcome = push(setting, ticks, seed);
    const std::string row = "seed " + std::to_string(seed);
    if (setting.wrist > 0.0 && outcome.chatter > 0.2)
      result.fail(row, "chattered by more than 0.2 N m");
    if (outcome.deepest > 5e-3) result.fail(row, "got more than 5 mm into a wall");
    if ((outcome.said & status::blind) != 0U) result.fail(row, "sound readings were not believed");
    result.rows.push_back({seed, setting.scene, setting.rate, rounded(setting.inertia, 0.01),
                           setting.delay, rounded(setting.wrist, 1e-6), setting.hand,
                           rounded(setting.hand_speed, 0.01),
                           rounded(outcome.sampling_energy, 1e-3),
                           rounded(outcome.fastest_joint, 0.01), rounded(outcome.chatter, 1e-3),
                           rounded(1e3 * outcome.deepest, 1e-3), to_text(outcome.said)});
    bench::progress("limits", i + 1, count);
  }
  result.notes = {
      "The walls are those of the scenes, as springs. A link that is light has no friction, and "
      "its "
      "joint ends are damped by 20 N m s/rad. The hand moves for 5 s as in the random pushes, and "
      "then rests.",
      "A row fails where a light joint chatters by more than 0.2 N m, the tool gets deeper than 5 "
      "mm, or sound readings are not believed. What sampling gives to an arm that a hand shakes is "
      "shown and not judged: it grows with the square of the force and the period."};
  return result;
}

constexpr std::array<bench::Part, 4> all{
    bench::Part{"pushes", "how deep hands get into springs and hard walls", pushes},
    bench::Part{"ways", "the same with what others do", ways},
    bench::Part{"attacks", "random walls, arms, delays and hands", attacks},
    bench::Part{"limits", "light wrists, late drives and fast hands", limits}};
constexpr bench::Program program{"hard_walls",
                                 "How deep hands that push at random get into walls.",
                                 all,
                                 "the pushes of the hands",
                                 "Everything but the times repeats itself.",
                                 "none"};

}  // namespace

int main(int argc, char** argv) {
  return repel::bench::start<program>(argc, argv);
}
