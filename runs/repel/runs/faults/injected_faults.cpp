// SPDX-License-Identifier: BSD-3-Clause
#include <repel/runs/faults/injected_faults.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <repel/cell/layout.hpp>
#include <repel/loop/arms/arm_inertia.hpp>
#include <repel/runs/faults/spoilt_kinematics.hpp>
#include <repel/schedule/coprocessor.hpp>
#include <repel/simulated/wrapped_arm.hpp>

namespace repel::faults {
namespace {

using std::chrono::nanoseconds;

/// A simulated arm with a fault of its drive.
class SpoiltDrive final : public WrappedArm {
 public:
  SpoiltDrive(std::unique_ptr<TorqueDrivenArm> arm, Exchange& exchange, const Fault& fault)
      : WrappedArm(std::move(arm)),
        x_(exchange),
        fault_(fault),
        sent_(exchange.drive.size()),
        given_(sent_) {}

  void set_torques(std::span<const double> torques) noexcept override {
    if (torques.size() != sent_.size()) return inside().set_torques(torques);
    std::ranges::copy(torques, sent_.begin());
    x_.sent.push(sent_);
    for (std::size_t i = 0; i < sent_.size(); ++i) x_.drive[i].torque = sent_[i];
    x_.stops = false;
    fault_.act(Kind::drive, x_);
    for (std::size_t i = 0; i < sent_.size(); ++i) {
      const double most = x_.drive[i].effort;
      given_[i] = std::clamp(x_.drive[i].torque, -most, most);
    }
    inside().set_torques(given_);
    if (x_.stops) inside().stop();
  }

 private:
  Exchange& x_;
  const Fault& fault_;
  std::vector<double> sent_, given_;  // [N m] or [N]
};

/// Unit, from the tool of the first arm to the nearest wall, as of the last tick; zero if none is
/// near.
Vec3 to_nearest_wall(const Cell& cell) noexcept {
  const World& world = cell.world();
  const BodyId tool = cell.layout(0).tool;
  double nearest = std::numeric_limits<double>::infinity();
  Vec3 direction = Vec3::Zero();
  cell.coprocessor().for_each_near([&](const NearPair& near) {
    const Pair& pair = world.pair(near.pair);
    const bool is_a = world.part(pair.a).body == tool;
    if (pair.law.passable || (!is_a && world.part(pair.b).body != tool)) return;
    const Separation& s = near.separation;
    if (!(s.distance < nearest) || s.end == QueryEnd::bad_input) return;
    nearest = s.distance;
    direction = is_a ? Vec3(-s.extraction_W) : s.extraction_W;
  });
  return direction;
}

/// A clock near its end cannot be changed further.
bool is_far_from_its_ends(nanoseconds now) {
  return now > nanoseconds::min() / 4 && now < nanoseconds::max() / 4;
}

}  // namespace

InjectedFaults::InjectedFaults(std::span<const Choice> choices, const ArmDescription& arm,
                               double rate_hz)
    : period_(1.0 / rate_hz),
      period_ns_(std::llround(1e9 * period_)),
      start_(arm.start),
      kinematics_(arm.model),
      jacobian_(Jacobian::Zero(6, kinematics_.links())) {
  for (const Choice& choice : choices) {
    const Fault& fault = fault_named(choice.name);
    if (fault.needs == Needs::two_joints && start_.size() < 2) {
      throw SetupError("the fault '" + choice.name +
                       "' is one of two joints; allowed: with an arm that has them");
    }
    checked("begin of the fault '" + choice.name + "'", choice.begin, 0.0, latest_begin, "s");
    // The drive is late outside of what is spoilt: see make_arms.
    Exchange x(start_, period_, 0);
    x.random.seed(1 + all_.size());
    for (std::size_t i = 0; i < start_.size(); ++i) x.drive[i].effort = effort_bound(arm.model, i);
    all_.push_back({&fault, choice.begin, std::move(x)});
  }
}

std::unique_ptr<ArmKinematics> InjectedFaults::spoilt(std::unique_ptr<ArmKinematics> sound) {
  for (Injected& each : all_) {
    if (each.fault->kind != Kind::kinematics) continue;
    sound = std::make_unique<SpoiltKinematics>(std::move(sound), each.x, each.fault);
  }
  return sound;
}

std::unique_ptr<TorqueDrivenArm> InjectedFaults::spoilt(std::unique_ptr<TorqueDrivenArm> sound) {
  for (Injected& each : all_) {
    if (each.fault->kind != Kind::drive) continue;
    sound = std::make_unique<SpoiltDrive>(std::move(sound), each.x, *each.fault);
  }
  return sound;
}

void InjectedFaults::begin_tick(const Cell& cell, const TickRecord* last) noexcept {
  const double due = last == nullptr ? 0.0 : last->time + period_;
  for (Injected& each : all_) {
    if (each.x.since >= 0) {
      ++each.x.since;
    } else if (due > each.begin - 0.5 * period_) {
      aim(each.x, cell, last);
      each.x.since = 0;
    }
  }
}

InjectedFaults::Told InjectedFaults::tell(nanoseconds now) noexcept {
  Told told{now + stood_};
  for (Injected& each : all_) {
    Exchange& x = each.x;
    if (each.fault->kind != Kind::clock || !is_far_from_its_ends(told.now)) continue;
    x.missed = 0;
    x.now = told.now;
    each.fault->act(Kind::clock, x);
    if (x.since < 0) x.begun = x.now;
    told.now = x.now + x.missed * period_ns_;
    told.missed += x.missed;
    stood_ += x.missed * period_ns_;
  }
  return told;
}

void InjectedFaults::spoil(ArmReadings& readings) noexcept {
  for (Injected& each : all_) {
    Exchange& x = each.x;
    if (each.fault->kind != Kind::readings) continue;
    std::ranges::copy(readings.q, x.read.q.begin());
    std::ranges::copy(readings.v, x.read.v.begin());
    x.older.push(x.read);
    if (x.since < 0) x.held = x.read;
    each.fault->act(Kind::readings, x);
    readings.q = x.read.q;
    readings.v = x.read.v;
  }
}

void InjectedFaults::spoil(network::Command& command) noexcept {
  for (Injected& each : all_) {
    if (each.fault->kind != Kind::operators) continue;
    each.x.command = command;
    each.fault->act(Kind::operators, each.x);
    command = each.x.command;
  }
}

void InjectedFaults::aim(Exchange& x, const Cell& cell, const TickRecord* last) noexcept {
  constexpr double at_rest = 1e-3;   // [m/s]
  constexpr double no_lever = 1e-6;  // of that of the shoulder
  const double* const q = last == nullptr ? start_.data() : last->q.data();
  kinematics_.update({q, start_.size()});
  kinematics_.tool_jacobian(jacobian_);
  x.inward = to_nearest_wall(cell);
  if (x.inward.isZero() && last != nullptr && last->v_WT.norm() > at_rest) {
    x.inward = last->v_WT.normalized();
  }
  if (x.inward.isZero()) x.inward = -Vec3::UnitZ();
  const auto moves = [&](std::size_t joint) -> Vec3 {
    return jacobian_.col(static_cast<Eigen::Index>(joint)).head<3>();
  };
  for (std::size_t i = 0; i < start_.size(); ++i) {
    if (moves(i).norm() > moves(x.shoulder).norm()) x.shoulder = i;
    x.away[i] = moves(i).dot(x.inward) > 0.0 ? -1.0 : 1.0;
  }
  x.wrist = x.shoulder;
  for (std::size_t i = 0; i < start_.size(); ++i) {
    const double lever = moves(i).norm();
    const bool is_one = lever > no_lever * moves(x.shoulder).norm();
    if (is_one && lever <= moves(x.wrist).norm()) x.wrist = i;
  }
}

}  // namespace repel::faults
