// SPDX-License-Identifier: BSD-3-Clause
#include "trial.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include <repel/cell/cell.hpp>
#include <repel/runs/faults/spoilt_kinematics.hpp>
#include <repel/simulated/arm_drive.hpp>
#include <repel/world/kinematics.hpp>

namespace repel::faults {
namespace {

constexpr double duration = 3.0;     // [s] from the fault's begin on
constexpr double speed = 0.25;       // [m/s] of the hand
constexpr double near_wall = 0.015;  // [m]
constexpr double settled = 0.6;      // [s] from there on until a fault begins while pressing
constexpr double allowed = 1e-3;     // [m] into a hard wall
constexpr double more = 5e-3;        // [m] into a soft wall, than without a fault
constexpr Status telling = status::failsafe | status::hold_lost;
constexpr Status blind = status::blind | status::bad_pose;

/// An arm, its cell and what passes between them.
class Loop {
 public:
  Loop(const Setting& setting, Rig rig, const Fault* fault)
      : has_brakes_(setting.has_brakes),
        rig_(std::move(rig)),
        fault_(fault),
        x_(rig_.start, 1.0 / setting.rate, rig_.late),
        truth_(rig_.plant, rig_.parts),
        plant_(rig_.plant),
        cell_(described(rig_, setting, kinematics())) {
    truth_.set_wall(rig_.X_WB, rig_.half);
    plant_.reset(rig_.start);
    x_.shoulder = rig_.shoulder;
    x_.wrist = rig_.wrist;
    x_.inward = rig_.inward;
    x_.random.seed(setting.seed);
    for (std::size_t i = 0; i < x_.drive.size(); ++i) {
      x_.drive[i].effort = rig_.model.links[i].effort_limit;
    }
    gap_ = truth_.gap(rig_.start);
    tool_ = truth_.tool(rig_.start);
    note_ways();
  }

  /// One tick. @param since the fault began
  const TickRecord& tick(int since) {
    x_.since = since;
    tell_time();
    sense();
    x_.command = {};
    if (rig_.led != nullptr) {
      rig_.led(x_, time_);
    } else {
      x_.command.hand.ball.linear = speed * rig_.inward;
    }
    change(Kind::operators);
    const TickRecord& record = *cell_.act({&x_.command, 1}).front();
    apply(record);
    move(1);
    return record;
  }

  [[nodiscard]] double gap() const { return gap_; }                ///< [m] true
  [[nodiscard]] double tool_speed() const { return tool_speed_; }  ///< [m/s] true
  [[nodiscard]] double joint_speed() const {
    double most = 0.0;
    for (const double v : plant_.v()) most = std::max(most, std::abs(v));
    return most;
  }
  [[nodiscard]] bool is_unsound(const TickRecord& record) const {
    for (std::size_t i = 0; i < x_.drive.size(); ++i) {
      if (!(std::abs(record.torques[i]) <= x_.drive[i].effort * (1.0 + 1e-9))) return true;
    }
    return false;
  }

 private:
  std::unique_ptr<ArmKinematics> kinematics() {
    return std::make_unique<SpoiltKinematics>(std::make_unique<Kinematics>(rig_.model), x_, fault_);
  }

  void change(Kind kind) {
    if (fault_ != nullptr) fault_->act(kind, x_);
  }

  void tell_time() {
    x_.missed = 0;
    true_now_ += cell_.period();
    x_.now = true_now_;
    change(Kind::clock);
    if (x_.since < 0) x_.begun = x_.now;
    if (x_.missed == 0) return;
    move(x_.missed);
    true_now_ += x_.missed * cell_.period();
    x_.now = true_now_;
  }

  void sense() {
    x_.read = {plant_.q(), plant_.v()};
    if (rig_.sensed != nullptr) rig_.sensed(x_);
    x_.older.push(x_.read);
    if (x_.since < 0) {
      x_.held = x_.read;
      note_ways();
    }
    change(Kind::readings);
    const ArmReadings readings{x_.read.q, x_.read.v, drive_.state(), {}};
    cell_.sense({&readings, 1}, x_.now);
  }

  void apply(const TickRecord& record) {
    if (record.enable) drive_.enable();
    drive_.heard();
    drive_.engage_brakes(record.brakes && has_brakes_);
    const auto begin = record.torques.begin();
    x_.sent.push({begin, begin + static_cast<std::ptrdiff_t>(x_.drive.size())});
    const std::vector<double>& acts = x_.sent[x_.late];
    for (std::size_t i = 0; i < acts.size(); ++i) x_.drive[i].torque = acts[i];
    x_.stops = false;
    change(Kind::drive);
    if (x_.stops) drive_.stop();
  }

  void move(int ticks) {
    for (int k = 0; k < ticks; ++k) {
      (void)drive_.advance(x_.period);
      plant_.step(x_.period, x_.drive, drive_.braked());
      time_ += x_.period;
    }
    gap_ = truth_.gap(plant_.q());
    const Vec3 tool = truth_.tool(plant_.q());
    tool_speed_ = (tool - tool_).norm() / (x_.period * ticks);
    tool_ = tool;
  }

  // The sign by which a reading of each joint must be wrong for the wall to seem farther off.
  void note_ways() {
    std::vector<double> q = plant_.q();
    for (std::size_t i = 0; i < q.size(); ++i) {
      q[i] += 1e-3;
      x_.away[i] = truth_.gap(q) < truth_.gap(plant_.q()) ? -1.0 : 1.0;
      q[i] -= 1e-3;
    }
  }

  bool has_brakes_;
  Rig rig_;
  const Fault* fault_;
  Exchange x_;
  Truth truth_;
  Plant plant_;
  Cell cell_;
  ArmDrive drive_{0.1};
  std::chrono::nanoseconds true_now_{0};
  double time_ = 0.0;  // [s]
  double gap_ = 0.0, tool_speed_ = 0.0;
  Vec3 tool_{0, 0, 0};
};

/// Says when a fault is due: at a gap drawn from 15 to 45 mm, or some time after the wall was near.
class Begin {
 public:
  Begin(const Setting& setting) : setting_(setting), random_(setting.seed) {
    at_ = std::uniform_real_distribution<double>(0.015, 0.045)(random_);
  }
  bool is_due(double gap) {
    if (setting_.situation == Situation::on_the_way) return gap < at_;
    if (gap < near_wall || since_ > 0) ++since_;
    return since_ > settled * setting_.rate;
  }

 private:
  const Setting& setting_;
  std::mt19937_64 random_;
  double at_;      // [m]
  int since_ = 0;  // ticks near the wall
};

}  // namespace

Outcome run(const Setting& setting, const Fault* fault) {
  Loop loop(setting, make_rig(setting.arm, setting.hold), fault);
  Begin begin(setting);
  Outcome out;
  Status before = 0;
  double depth = 0.0;  // [m] at the begin
  const int latest = static_cast<int>(5.0 * setting.rate);
  const int last = static_cast<int>(duration * setting.rate);
  for (int k = 0; k < latest + last; ++k) {
    if (out.begun < 0 && (k >= latest || begin.is_due(loop.gap()))) {
      if (k >= latest) return out;
      out.begun = k;
      depth = std::max(0.0, -loop.gap());
    }
    const int since = out.begun < 0 ? -1 : k - out.begun;
    if (since > last) break;
    const TickRecord& record = loop.tick(since);
    if (since < 0) {
      before = record.status;
      continue;
    }
    const Status news = record.status & telling & ~before;
    if (out.told == 0U && news != 0U) out.told = news, out.told_after = since;
    out.seen |= record.status;
    out.worst = std::max(out.worst, record.stop);
    out.unsound = out.unsound || loop.is_unsound(record);
    out.deepest = std::max(out.deepest, -loop.gap() - depth);
    out.tool_speed = std::max(out.tool_speed, loop.tool_speed());
    out.joint_speed = std::max(out.joint_speed, loop.joint_speed());
    if (loop.gap() > -0.1 && loop.joint_speed() < 30.0) continue;
    out.ran_away = true;
    break;
  }
  return out;
}

Verdict judge(const Fault& fault, const Setting& setting, const Outcome& outcome,
              const Outcome& without) {
  if (outcome.unsound || outcome.begun < 0) return Verdict::falls_short;
  const double most = setting.hold == HoldKind::hard ? allowed : without.deepest + more;
  if (outcome.deepest <= most && !outcome.ran_away) return Verdict::ok;
  return fault.demand == Demand::notice ? Verdict::excused : Verdict::falls_short;
}

namespace {

// Into the wall, at rest against it, along it and turning, and back.
void lead(Exchange& x, double time) {
  const Vec3 aside = x.inward.unitOrthogonal();
  Twist& V = x.command.hand.ball;
  if (time < 2.0) V.linear = 0.15 * x.inward;
  if (time >= 4.0 && time < 5.0) V = {Vec3(0.1 * aside), Vec3(0.2 * aside)};
  if (time >= 5.0 && time < 6.0) V = {Vec3(0.2 * x.inward), Vec3(-0.2 * aside)};
  if (time >= 6.5 && time < 7.5) V.linear = -0.2 * x.inward;
}

}  // namespace

Calm run(const Setting& setting, const Sound& sound) {
  Rig rig = make_rig(setting.arm, setting.hold);
  rig.led = lead;
  sound.change(rig);
  Loop loop(setting, std::move(rig), nullptr);
  Calm calm;
  for (; calm.ticks < static_cast<int>(8.0 * setting.rate); ++calm.ticks) {
    const TickRecord& record = loop.tick(-1);
    if (calm.first == 0U && (record.status & telling) != 0U) {
      calm.first = record.status & telling;
      calm.first_at = calm.ticks;
    }
    calm.seen |= record.status & telling;
    calm.blind += (record.status & blind) != 0U ? 1 : 0;
    calm.stopped += record.stop != Stop::running || record.gain < 1.0 ? 1 : 0;
    calm.deepest = std::max(calm.deepest, -loop.gap());
    calm.unsound = calm.unsound || loop.is_unsound(record);
  }
  return calm;
}

Verdict judge(const Calm& calm) {
  const bool is_calm = calm.blind == 0 && 100 * calm.stopped <= calm.ticks && !calm.unsound &&
                       calm.deepest <= allowed;
  return is_calm ? Verdict::ok : Verdict::falls_short;
}

}  // namespace repel::faults
