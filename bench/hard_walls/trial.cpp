// SPDX-License-Identifier: BSD-3-Clause
#include "trial.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <random>
#include <utility>

#include <repel/cell/arm_port.hpp>
#include <repel/cell/cell.hpp>
#include <repel/cell/layout.hpp>
#include <repel/loop/tick.hpp>
#include <repel/network/modules.hpp>
#include <repel/runs/arms/arm_backend.hpp>
#include <repel/runs/arms/servoed_arm.hpp>
#include <repel/runs/watch/chatter.hpp>
#include <repel/simulated/delayed_arm.hpp>

#include "command_filter.hpp"
#include "gaps.hpp"
#include "libccd_depth.hpp"
#include "torque_filter.hpp"

namespace repel::hard_walls {
namespace {

using std::chrono::nanoseconds;

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

/// The simulated arms of a cell, and what moves them.
struct Driven {
  Driven(const Setting& setting, const scene::Scene& scene, const runs::DescribedScene& described) {
    for (std::size_t i = 0; i < described.cell.arms.size(); ++i) {
      const ArmDescription& arm = described.cell.arms[i];
      const ArmModel& model = described.robots[i].arm;
      ArmModel plant = model;
      for (ArmLink& link : plant.links) {
        link.mass *= setting.inertia;
        link.I_C_L = setting.inertia * link.I_C_L;
        link.rotor_inertia *= setting.inertia;
      }
      arms.push_back(runs::arm_backend("bullet").make(plant, arm.start, 0.1, {}));
      if (setting.delay > 0) {
        arms.back() =
            std::make_unique<DelayedArm>(std::move(arms.back()), plant.links.size(), setting.delay);
      }
      if (const auto& admittance = scene.arm_setup(i).robot.admittance) {
        arms.back() = std::make_unique<runs::ServoedArm>(std::move(arms.back()), model, arm.model,
                                                         admittance->response, 1.0 / setting.rate);
      }
      ports.emplace_back(*arms.back(), plant.links.size());
      hands.emplace_back(setting.seed + 1000 * hands.size(), setting.hand_speed);
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

/// What others do, if the setting is about them.
class Filter {
 public:
  Filter(const Setting& setting, const scene::Scene& scene) : way_(setting.way) {
    if (way_ == Way::hard || way_ == Way::springs) return;
    Setting walled = setting;
    walled.way = Way::hard;
    gaps_.emplace(described(walled, scene).cell, is_of_arm(way_));
    for (std::size_t i = 0; is_of_arm(way_) && i < gaps_->cell().arms(); ++i) {
      of_torques_.emplace_back(way_, gaps_->cell(), i);
    }
  }
  /// Of what the hands command, in a tick that is due at `now`.
  void change(Driven& driven, nanoseconds now) {
    if (!gaps_) return;
    gaps_->sense(driven.readings, now);
    const auto begin = std::chrono::steady_clock::now();
    gaps_->collect(is_of_arm(way_) ? 1.0 : 0.2);
    for (std::size_t i = 0; !is_of_arm(way_) && i < driven.commands.size(); ++i) {
      const BodyId tool = gaps_->cell().layout(i).tool;
      filter_command(way_, gaps_->all(), tool, driven.commands[i].hand.ball);
    }
    spent_ = std::chrono::steady_clock::now() - begin;
  }
  /// Of the torques that are sent in this tick.
  void change(const Driven& driven, std::span<TickRecord> sent) {
    if (!gaps_) return;
    const auto begin = std::chrono::steady_clock::now();
    for (std::size_t i = 0; i < of_torques_.size(); ++i) {
      const auto torques = std::span(sent[i].torques).first(driven.readings[i].q.size());
      of_torques_[i].filter(gaps_->all(), driven.readings[i], torques);
    }
    time_.record(spent_ + (std::chrono::steady_clock::now() - begin));
  }
  /// Of all ticks, without that of the second cell.
  [[nodiscard]] const DurationHistogram& time() const { return time_; }

 private:
  Way way_;
  std::optional<Gaps> gaps_;
  std::vector<TorqueFilter> of_torques_;
  nanoseconds spent_{0};
  DurationHistogram time_;
};

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

}  // namespace

Outcome push(const Setting& setting) {
  const scene::Scene scene = load(setting.scene);
  runs::DescribedScene set_up = described(setting, scene);
  Driven driven(setting, scene, set_up);
  Cell cell(std::move(set_up.cell));
  Filter filter(setting, scene);
  LibccdDepth libccd(cell);
  Outcome outcome;
  std::vector<runs::ChatterMeter> meters;
  for (std::size_t i = 0; i < cell.arms(); ++i) meters.emplace_back(1, setting.rate);
  nanoseconds now{0};
  for (std::int64_t tick = 0; tick < setting.ticks; ++tick) {
    now += cell.period();
    for (std::size_t i = 0; i < cell.arms(); ++i) {
      driven.readings[i] = driven.ports[i].read();
      driven.commands[i] = driven.hands[i].step(1.0 / setting.rate);
      if (static_cast<double>(tick) > setting.hand_until * setting.rate) {
        driven.commands[i].hand.ball = {};
      }
    }
    if (has_libccd && setting.libccd_every > 0 && tick % setting.libccd_every == 0) {
      const double depth = libccd.at(driven.readings, static_cast<double>(tick) / setting.rate);
      outcome.by_libccd = std::max(outcome.by_libccd, depth);
      if (depth > tolerated && !outcome.entered) outcome.entered = tick;
    }
    filter.change(driven, now);
    const auto begin = std::chrono::steady_clock::now();
    cell.sense(driven.readings, now);
    const auto records = cell.act(driven.commands);
    outcome.compute.record(std::chrono::steady_clock::now() - begin);
    std::vector<TickRecord> sent;
    for (const TickRecord* record : records) sent.push_back(*record);
    filter.change(driven, sent);
    for (std::size_t i = 0; i < cell.arms(); ++i) {
      const bool is_lost = (records[i]->status & status::hold_lost) != 0U;
      outcome.lost += is_lost ? 1 : 0;
      if (is_lost && !outcome.told) outcome.told = tick;
      if (records[i]->pairs.nearest < -tolerated && !outcome.entered) outcome.entered = tick;
      outcome.way += records[i]->v_WT.norm() / setting.rate;
      note_motion(cell, i, *records[i], outcome);
      // What swings out at the end of the motion is none.
      if (static_cast<double>(tick) > (setting.hand_until + 1.0) * setting.rate) {
        const std::size_t last = driven.readings[i].q.size() - 1;
        meters[i].add(std::span(records[i]->torques).subspan(last, 1));
      }
      driven.ports[i].apply(sent[i]);
      driven.arms[i]->step(1.0 / setting.rate);
    }
  }
  outcome.filter = filter.time();
  note_pairs(cell, outcome);
  for (const runs::ChatterMeter& meter : meters) {
    const double rms = meter.of(0).rms;
    if (rms > outcome.chatter) outcome.chatter = rms;
  }
  return outcome;
}

}  // namespace repel::hard_walls
