// SPDX-License-Identifier: BSD-3-Clause
// The faults: one line for each.
#include <repel/runs/faults/exchange.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace repel::faults {
namespace {

using std::chrono::milliseconds;
using std::chrono::nanoseconds;
using X = Exchange;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double inf = std::numeric_limits<double>::infinity();

void fill(std::vector<double>& all, double value) {
  std::fill(all.begin(), all.end(), value);
}
void scale(std::vector<double>& all, double factor) {
  for (double& x : all) x *= factor;
}
void add_noise(X& x, std::vector<double>& all, double deviation) {
  for (double& value : all) value += x.noise(deviation);
}
void round_to(std::vector<double>& all, double step) {
  for (double& x : all) x = step * std::round(x / step);
}
// The highest bit of the exponent but one: a factor of 2^256 or its inverse.
void flip_bit(double& x) {
  x = std::bit_cast<double>(std::bit_cast<std::uint64_t>(x) ^ (std::uint64_t{1} << 60U));
}
// As of a gear that is another one than in the model.
void gear_error(X& x) {
  x.stretch(x.shoulder, 0.9);
}
// A drift that the rate confirms.
void drift_with_rate(X& x) {
  x.drift(x.shoulder, 0.1);
  x.v() += 0.1 * x.away[x.shoulder];
}
void exchange_joints(X& x) {
  std::swap(x.q(), x.wrist_q());
  std::swap(x.v(), x.wrist_v());
}

Eigen::Index at(std::size_t i) {
  return static_cast<Eigen::Index>(i);
}
void couple(X& x, double mass) {
  x.answers.M(0, 1) = x.answers.M(1, 0) = mass;
}
void exchange_columns(X& x) {
  x.answers.J.col(at(x.shoulder)).swap(x.answers.J.col(at(x.wrist)));
}
void retreat(X& x, double way) {
  x.answers.X_WT.pretranslate(Vec3(-way * x.inward));
}

void jitter(X& x) {
  x.now += nanoseconds(static_cast<std::int64_t>(1e9 * x.period * x.noise(0.4)));
}

void scale_torques(X& x, double factor) {
  for (DriveOfJoint& joint : x.drive) joint.torque *= factor;
}
void weaken(X& x) {
  for (DriveOfJoint& joint : x.drive) {
    joint.torque = std::clamp(joint.torque, -0.5 * joint.effort, 0.5 * joint.effort);
  }
}
// Towards the wall.
void add_torque(X& x) {
  x.torque() -= 0.05 * x.away[x.shoulder] * x.drive[x.shoulder].effort;
}

// [m/s] A square wave.
double wave(const X& x, double frequency) {
  return std::fmod(x.time() * frequency, 1.0) < 0.5 ? 10.0 : -10.0;
}
Vec3 aslant(const X& x) {
  return x.inward + Vec3(0.5, 0.5, 0.5);
}
void pull_lever(X& x) {
  x.command.hand.lever_rate = 1e6;
  x.command.hand.direction_W = x.inward;
}

constexpr auto notice = Demand::notice;
constexpr auto hold = Demand::hold;
constexpr auto two = Needs::two_joints;
constexpr auto brakes = Needs::joint_brakes;
constexpr int always = 1;
constexpr int once = 0;
constexpr auto R = Kind::readings;
constexpr auto K = Kind::kinematics;
constexpr auto C = Kind::clock;
constexpr auto D = Kind::drive;
constexpr auto O = Kind::operators;

constexpr Fault table[] = {
    {"position frozen, shoulder", R, [](X& x) { x.q() = x.held_q(); }},
    {"position frozen, wrist", R, [](X& x) { x.wrist_q() = x.held.q[x.wrist]; }},
    {"encoder frozen, shoulder", R, [](X& x) { x.q() = x.held_q(), x.v() = 0.0; }},
    {"encoder frozen, wrist", R, [](X& x) { x.wrist_q() = x.held.q[x.wrist], x.wrist_v() = 0.0; }},
    {"joint frozen with its rate, shoulder", R, [](X& x) { x.freeze(x.shoulder); }},
    {"all positions frozen", R, [](X& x) { x.read.q = x.held.q; }},
    {"all encoders frozen", R, [](X& x) { x.read.q = x.held.q, fill(x.read.v, 0.0); }},
    {"frame frozen", R, [](X& x) { x.read = x.held; }},
    {"frame of zeros once", R, [](X& x) { fill(x.read.q, 0.0), fill(x.read.v, 0.0); }, once},
    {"frame of zeros", R, [](X& x) { fill(x.read.q, 0.0), fill(x.read.v, 0.0); }},
    {"position NaN once", R, [](X& x) { x.q() = nan; }, once},
    {"position NaN, wrist", R, [](X& x) { x.wrist_q() = nan; }},
    {"all positions NaN", R, [](X& x) { fill(x.read.q, nan); }},
    {"positions NaN every other tick", R, [](X& x) { fill(x.read.q, nan); }, 2},
    {"position infinite, shoulder", R, [](X& x) { x.q() = inf; }},
    {"position 1e308 once", R, [](X& x) { x.q() = 1e308; }, once},
    {"slipped away by 2 mrad, shoulder", R, [](X& x) { x.shift(x.shoulder, 0.002); }},
    {"slipped away by 0.02 rad, shoulder", R, [](X& x) { x.shift(x.shoulder, 0.02); }},
    {"slipped away by 0.1 rad, shoulder", R, [](X& x) { x.shift(x.shoulder, 0.1); }},
    {"slipped away by 1 rad, shoulder", R, [](X& x) { x.shift(x.shoulder, 1.0); }},
    {"slipped towards by 0.1 rad, shoulder", R, [](X& x) { x.shift(x.shoulder, -0.1); }},
    {"slipped away by 0.02 rad, wrist", R, [](X& x) { x.shift(x.wrist, 0.02); }},
    {"slipped away by 0.1 rad, wrist", R, [](X& x) { x.shift(x.wrist, 0.1); }},
    {"jump by 0.1 rad once", R, [](X& x) { x.shift(x.shoulder, 0.1); }, once},
    {"jump by 5 mrad every 10th tick", R, [](X& x) { x.shift(x.shoulder, 0.005); }, 10},
    {"position times 1.1, shoulder", R, [](X& x) { x.q() *= 1.1; }},
    {"position times 0.9, shoulder", R, [](X& x) { x.q() *= 0.9; }},
    {"way and rate times 0.9 from here on", R, gear_error, always, notice},
    {"position turned round, shoulder", R, [](X& x) { x.q() *= -1.0; }},
    {"way and rate turned round from here on", R, [](X& x) { x.stretch(x.shoulder, -1.0); }},
    {"drift of 1 mrad/s, shoulder", R, [](X& x) { x.drift(x.shoulder, 1e-3); }, always, notice},
    {"drift of 20 mrad/s, shoulder", R, [](X& x) { x.drift(x.shoulder, 0.02); }},
    {"drift of 0.1 rad/s, shoulder", R, [](X& x) { x.drift(x.shoulder, 0.1); }},
    {"drift of 0.1 rad/s with its rate, shoulder", R, drift_with_rate, always, notice},
    {"drift of 0.1 rad/s, wrist", R, [](X& x) { x.drift(x.wrist, 0.1); }},
    {"noise of 0.1 mrad", R, [](X& x) { add_noise(x, x.read.q, 1e-4); }},
    {"noise of 1 mrad", R, [](X& x) { add_noise(x, x.read.q, 1e-3); }},
    {"noise of 10 mrad", R, [](X& x) { add_noise(x, x.read.q, 1e-2); }},
    {"noise of 0.1 rad/s", R, [](X& x) { add_noise(x, x.read.v, 0.1); }},
    {"quantised to 1 mrad", R, [](X& x) { round_to(x.read.q, 1e-3); }},
    {"quantised to 10 mrad", R, [](X& x) { round_to(x.read.q, 1e-2); }},
    {"rates NaN", R, [](X& x) { fill(x.read.v, nan); }},
    {"rates zero", R, [](X& x) { fill(x.read.v, 0.0); }},
    {"rate zero, shoulder", R, [](X& x) { x.v() = 0.0; }},
    {"rates turned round", R, [](X& x) { scale(x.read.v, -1.0); }},
    {"rate turned round, shoulder", R, [](X& x) { x.v() *= -1.0; }},
    {"rates halved", R, [](X& x) { scale(x.read.v, 0.5); }},
    {"rates doubled", R, [](X& x) { scale(x.read.v, 2.0); }},
    {"rate of -1e308 once", R, [](X& x) { x.wrist_v() = -1e308; }, once},
    {"rates exchanged", R, [](X& x) { std::swap(x.v(), x.wrist_v()); }, always, hold, two},
    {"positions exchanged", R, [](X& x) { std::swap(x.q(), x.wrist_q()); }, always, hold, two},
    {"joints exchanged", R, exchange_joints, always, hold, two},
    {"readings late by a tick", R, [](X& x) { x.read = x.before(1); }},
    {"readings late by 2 ticks", R, [](X& x) { x.read = x.before(2); }},
    {"readings late by 5 ticks", R, [](X& x) { x.read = x.before(5); }},
    {"readings late by 20 ms", R, [](X& x) { x.read = x.before(x.ticks(0.02)); }},
    {"readings late by 50 ms", R, [](X& x) { x.read = x.before(x.ticks(0.05)); }, always, notice},
    {"every other frame repeated", R, [](X& x) { x.read = x.before(x.since % 2); }},
    {"three of four frames repeated", R, [](X& x) { x.read = x.before(x.since % 4); }},
    {"position turned round every 7th tick", R, [](X& x) { x.q() *= -1.0; }, 7},
    {"bit of an exponent once", R, [](X& x) { flip_bit(x.q()); }, once},
    {"bit of a rate's exponent every 10th tick", R, [](X& x) { flip_bit(x.v()); }, 10},

    {"mass NaN on the diagonal once", K, [](X& x) { x.answers.M(0, 0) = nan; }, once},
    {"mass NaN on the diagonal", K, [](X& x) { x.answers.M(at(x.wrist), at(x.wrist)) = nan; }},
    {"mass NaN beside the diagonal once", K, [](X& x) { couple(x, nan); }, once, hold, two},
    {"mass NaN beside the diagonal", K, [](X& x) { couple(x, nan); }, always, hold, two},
    {"mass not positive definite once", K, [](X& x) { couple(x, 1e3); }, once, hold, two},
    {"mass not positive definite", K, [](X& x) { couple(x, 1e3); }, always, hold, two},
    {"mass negative", K, [](X& x) { x.answers.M *= -1.0; }},
    {"mass not symmetric", K, [](X& x) { x.answers.M(0, 1) += 0.5 * x.answers.M(0, 0); }, always,
     hold, two},
    {"mass zero", K, [](X& x) { x.answers.M.setZero(); }},
    {"mass 1e6 times", K, [](X& x) { x.answers.M *= 1e6; }},
    {"mass 1e-6 times", K, [](X& x) { x.answers.M *= 1e-6; }},
    {"weight 1e6 N m once", K, [](X& x) { fill(x.answers.gravity, 1e6); }, once},
    {"weight 1e6 N m", K, [](X& x) { fill(x.answers.gravity, 1e6); }},
    {"weight NaN", K, [](X& x) { fill(x.answers.gravity, nan); }},
    {"weight turned round", K, [](X& x) { scale(x.answers.gravity, -1.0); }},
    {"Jacobian NaN", K, [](X& x) { x.answers.J(2, at(x.shoulder)) = nan; }},
    {"Jacobian zero", K, [](X& x) { x.answers.J.setZero(); }},
    {"Jacobian doubled", K, [](X& x) { x.answers.J *= 2.0; }},
    {"Jacobian turned round", K, [](X& x) { x.answers.J *= -1.0; }},
    {"columns of the Jacobian exchanged", K, exchange_columns, always, hold, two},
    {"pose NaN once", K, [](X& x) { x.answers.X_WT.translation().y() = nan; }, once},
    {"pose NaN", K, [](X& x) { x.answers.X_WT.translation().y() = nan; }},
    {"pose no rotation", K, [](X& x) { x.answers.X_WT.linear() *= 1.5; }},
    {"pose away by 10 mm once", K, [](X& x) { retreat(x, 0.01); }, once},
    {"pose away by 10 mm", K, [](X& x) { retreat(x, 0.01); }},
    {"pose times 1.1", K, [](X& x) { x.answers.X_WT.translation() *= 1.1; }},
    {"pose frozen", K, [](X& x) { x.answers.X_WT = x.known.X_WT; }},
    {"all answers frozen", K, [](X& x) { x.answers = x.known; }},

    {"clock stopped", C, [](X& x) { x.now = x.begun; }},
    {"clock runs backwards", C, [](X& x) { x.now = 2 * x.begun - x.now; }},
    {"clock ahead by 10 ms", C, [](X& x) { x.now += milliseconds(10); }},
    {"clock ahead by 1 s", C, [](X& x) { x.now += milliseconds(1000); }},
    {"clock back by 10 ms", C, [](X& x) { x.now -= milliseconds(10); }},
    {"clock at its end", C, [](X& x) { x.now = nanoseconds::max(); }},
    {"clock at its beginning", C, [](X& x) { x.now = nanoseconds::min(); }},
    {"clock twice as fast", C, [](X& x) { x.now = 2 * x.now - x.begun; }},
    {"clock half as fast", C, [](X& x) { x.now -= (x.now - x.begun) / 2; }},
    {"clock jitters by 0.4 ticks", C, jitter},
    {"loop misses a tick in ten", C, [](X& x) { x.missed = 1; }, 10},
    {"loop stands still for 20 ms", C, [](X& x) { x.missed = x.ticks(0.02); }, once},
    {"loop stands still for 0.15 s", C, [](X& x) { x.missed = x.ticks(0.15); }, once, notice},

    {"drive dead, shoulder", D, [](X& x) { x.torque() = 0.0; }, always, notice},
    {"drive dead, wrist", D, [](X& x) { x.wrist_torque() = 0.0; }, always, notice},
    {"all drives dead", D, [](X& x) { scale_torques(x, 0.0); }, always, notice},
    {"torque turned round, shoulder", D, [](X& x) { x.torque() *= -1.0; }, always, notice},
    {"torque turned round, wrist", D, [](X& x) { x.wrist_torque() *= -1.0; }, always, notice},
    {"all torques turned round", D, [](X& x) { scale_torques(x, -1.0); }, always, notice},
    {"torques halved", D, [](X& x) { scale_torques(x, 0.5); }},
    {"torques doubled", D, [](X& x) { scale_torques(x, 2.0); }},
    {"drive late by a tick", D, [](X& x) { x.delay_drive(1); }},
    {"drive late by 2 ticks", D, [](X& x) { x.delay_drive(2); }},
    {"drive late by 5 ticks", D, [](X& x) { x.delay_drive(5); }},
    {"drive gives half its effort", D, weaken},
    {"drive adds 5 % of its effort", D, add_torque},
    {"brake does not release, shoulder", D, [](X& x) { x.drive[x.shoulder].brake_drags = 1.0; },
     always, hold, brakes},
    {"brake drags, wrist", D, [](X& x) { x.drive[x.wrist].brake_drags = 0.2; }, always, hold,
     brakes},
    {"brake does not hold, shoulder", D, [](X& x) { x.drive[x.shoulder].brake_holds = 0.0; },
     always, hold, brakes},
    {"drive stops by itself", D, [](X& x) { x.stops = x.since == 0; }},

    {"rates of the hand NaN", O, [](X& x) { x.ball().linear.setConstant(nan); }},
    {"turning of the hand NaN", O, [](X& x) { x.ball().angular.y() = nan; }},
    {"hand NaN every other tick", O, [](X& x) { x.ball().linear.x() = nan; }, 2},
    {"hand at 1e6 m/s", O, [](X& x) { x.ball().linear = 1e6 * x.inward; }},
    {"hand at 1e308 m/s", O, [](X& x) { x.ball().linear = 1e308 * x.inward; }},
    {"hand at 10 m/s", O, [](X& x) { x.ball().linear = 10.0 * x.inward; }},
    {"hand turns at 30 rad/s", O, [](X& x) { x.ball().angular = 30.0 * x.inward; }},
    {"hand turns round", O, [](X& x) { x.ball().linear *= -1.0; }},
    {"hand to and fro at 50 Hz", O, [](X& x) { x.ball().linear = wave(x, 50.0) * x.inward; }},
    {"hand to and fro at 5 Hz, aslant", O,
     [](X& x) { x.ball().linear = wave(x, 5.0) * aslant(x); }},
    {"scale NaN", O, [](X& x) { x.command.hand.scale = nan; }},
    {"scale 1e9", O, [](X& x) { x.command.hand.scale = 1e9; }},
    {"lever of 1e6 rad/s", O, pull_lever},
    {"direction of the lever NaN", O, [](X& x) { x.command.hand.direction_W.setConstant(nan); }},
    {"silent for NaN", O, [](X& x) { x.command.silent_for = nan; }},
    {"silent for -1 s", O, [](X& x) { x.command.silent_for = -1.0; }},
    {"silent for ever", O, [](X& x) { x.command.silent_for = inf; }},
    {"device silent", O, [](X& x) { x.command.silent_for = x.time(); }},
    {"device silent at times", O, [](X& x) { x.command.silent_for = std::fmod(x.time(), 0.05); }},
    {"said to be unsound every third tick", O, [](X& x) { x.command.sound = x.since % 3 != 0; }},
};

}  // namespace

std::span<const Fault> all_faults() {
  return table;
}

}  // namespace repel::faults
