// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The record of every tick, and the totals of a run.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include <repel/base/ids.hpp>
#include <repel/base/status.hpp>
#include <repel/network/operator.hpp>
#include <repel/network/plan.hpp>
#include <repel/pairs/forces_and_totals.hpp>
#include <repel/schedule/pair_forces.hpp>

namespace repel {

/// The proof for the hard walls of an arm in a tick: with arm and drive no worse than told, it can
/// be stopped before all of them (EntryBarrier, docs/walls.md).
struct HoldProof {
  /// [m] Proven distance to the hard walls after braking; below zero: not proven. Infinite if no
  /// hard wall is near, or something else holds the arm.
  double margin = std::numeric_limits<double>::infinity();
  PairId pair;                ///< of the smallest such gap; invalid: none is near
  double missed = 0.0;        ///< [m/s] excess of the closing speed of a gap, with torques at their
                              ///< limits (LeastConstraint::missed)
  std::int32_t left_out = 0;  ///< overflow: gaps not covered by the proof
};

using JointNumbers = std::array<double, network::most_joints>;        ///< zeros beyond the last
using ModuleEnergies = std::array<float, network::Plan::most_nodes>;  ///< likewise

/// One tick, as logged.
struct TickRecord {
  std::int64_t tick = 0;      ///< its number, from 0
  double time = 0.0;          ///< [s] since the first tick
  std::int32_t phase = 0;     ///< of the operator's script
  Status status = 0;          ///< the bits of what was noticed, 0 without a fault
  Stop stop = Stop::running;  ///< what was done about faults
  bool brakes = false;        ///< the brakes of the arm are requested
  bool enable = false;        ///< the stopped drive of the arm is to be enabled again
  std::int64_t elapsed = 1;   ///< [periods] since the last tick; more after missed ticks
  /// [rad] or [m] joints as read, or predicted where the reading was not believed.
  JointNumbers q{};
  JointNumbers v{};       ///< [rad/s] or [m/s] their rates
  JointNumbers q_read{};  ///< as read, believed or not
  JointNumbers v_read{};  ///< likewise
  /// [N, N m] of the force sensor, as read; empty without a reading or a module for it.
  std::optional<Wrench> wrench_read{};
  network::Command command;   ///< of the operator
  Vec3 p_WT{0, 0, 0};         ///< [m] tool
  Vec3 v_WT{0, 0, 0};         ///< [m/s]
  Wrench virtual_force;       ///< [N, N m] on the tool, about its origin
  Wrench coupling;            ///< [N, N m] from the operator's side on the tool
  double lever_torque = 0.0;  ///< [N m] reflected to the torque arm of the first hand
  Wrench grip;                ///< [N, N m] of SIX AXES on the first hand; not logged
  Wrench second_grip;         ///< [N, N m] and on a second one; likewise
  double gain = 1.0;          ///< of the fail-safe
  double held_force = 0.0;    ///< [N] of hard walls on the arm (loop/barrier/entry_barrier.hpp)
  PairId held_pair;           ///< that of the hardest one; invalid: none did
  HoldProof hold;             ///< what is proven of hard walls
  JointNumbers torques{};     ///< [N m] or [N] sent to the joints
  ModuleEnergies energy{};    ///< [J] ledger of each module of the network, in its order
  std::chrono::nanoseconds network_time{0};  ///< compute time of the network; not reproducible
  PairTotals pairs;                          ///< of all pairs of the world
  WorkerReport workers;                      ///< the coprocessor's threads
};

/// Metadata of a number of a tick: the files it is written to, and its name there.
struct TickField {
  const char* name;         ///< in Python; empty: not there
  const char* column = "";  ///< of CSV, with its unit; `*` is x, y and z, the number of the joint
                            ///< or the module; of joints for those that turn, a blank, and for
                            ///< those that slide; empty: none
  const char* entry = "";   ///< in the forces of a recording; empty: none
  const char* what = "";    ///< it is, with its unit
  bool may_lack = false;    ///< there is none where it is not finite, and in older recordings
};

/// Calls visit(TickField, x...) for every number of a tick written somewhere, x of each of
/// `records`, in the order of the CSV columns. A new one is entered here and in the record; files
/// and Python follow. Further input of a replay is in the inputs of a recording.
template <class Visit, class... Records>
constexpr void for_each_field(const Visit& visit, Records&... records) {
  visit(TickField{"tick", "", "", "Its number, from 0."}, records.tick...);
  visit(TickField{"time", "", "", "[s] since the first tick."}, records.time...);
  visit(TickField{"elapsed", "", "", "[periods] since the last tick; more after missed ticks."},
        records.elapsed...);
  visit(TickField{"enable", "", "", "Enable the stopped drive of the arm again."},
        records.enable...);
  visit(TickField{"phase", "phase", "", "Of the operator's script."}, records.phase...);
  visit(TickField{"status", "status", "",
                  "Faults and limits that were noticed, by their names; empty: none."},
        records.status...);
  visit(TickField{"p_WT", "*_m", "", "[m] the tool."}, records.p_WT...);
  visit(TickField{"v_WT", "v*_m_s", "", "[m/s] its velocity."}, records.v_WT...);
  visit(
      TickField{
          "virtual_force", "", "",
          "force [N] and torque [N m] of the walls on the tool, about its origin, world axes."},
      records.virtual_force...);
  visit(TickField{"", "virtual_f*_n", "force", "virtual [N]"}, records.virtual_force.force...);
  visit(TickField{"", "virtual_t*_nm", "torque", "virtual [N m]"}, records.virtual_force.torque...);
  visit(TickField{"coupling", "", "",
                  "force [N] and torque [N m] from the operator's side on the tool."},
        records.coupling...);
  visit(TickField{"", "coupling_f*_n", "coupling_force", "[N]"}, records.coupling.force...);
  visit(TickField{"", "", "coupling_torque", "[N m]"}, records.coupling.torque...);
  visit(
      TickField{"grip", "", "",
                "force [N] and torque [N m] of a master with six axes on the hand; times `gain`."},
      records.grip...);
  visit(TickField{"lever_torque", "lever_torque_nm", "lever_torque",
                  "[N m] reflected to the lever; times `gain`."},
        records.lever_torque...);
  visit(TickField{"gain", "gain", "gain", "Of the fail-safe, 0 to 1."}, records.gain...);
  visit(TickField{"q", "q*_rad q*_m", "",
                  "[rad] or [m] as read, or predicted where the reading was not believed."},
        records.q...);
  visit(TickField{"energy", "energy_*_j", "", "[J] the ledger of each module of the network."},
        records.energy...);
  visit(TickField{"stop", "stop", "stop",
                  "What was done about faults: running, holding, braking or released."},
        records.stop...);
  visit(TickField{"brakes", "brakes", "brakes", "Engage the brakes of the arm."},
        records.brakes...);
  visit(TickField{"torques", "tau*_nm tau*_n", "torques", "[N m] or [N] to be sent to the joints."},
        records.torques...);
  visit(TickField{"v", "v*_rad_s v*_m_s", "", "[rad/s] or [m/s] their rates."}, records.v...);
  visit(
      TickField{"held_force", "held_n", "held_n", "[N] with which hard walls held the arm.", true},
      records.held_force...);
  visit(TickField{"hold_margin", "hold_margin_m", "hold_margin_m",
                  "[m] How far off every hard wall the arm can still be stopped, by the proof; "
                  "infinite where none is near.",
                  true},
        records.hold.margin...);
}

/// Records the forces of the masters of the network on the hands; zero without a master.
void note_masters(const network::Network& network, TickRecord& record) noexcept;

/// Keeps the ticks of a run in memory reserved at set-up; ticks beyond it are dropped and counted.
class Recorder {
 public:
  /// Reserves the memory of `capacity` ticks.
  explicit Recorder(std::size_t capacity);

  /// Keeps a tick if there is room. Does not allocate.
  void add(const TickRecord& record) noexcept;
  /// Those kept, in their order.
  [[nodiscard]] const std::vector<TickRecord>& records() const noexcept { return records_; }
  /// Ticks for which there was no room.
  [[nodiscard]] std::int64_t dropped() const noexcept { return dropped_; }

 private:
  std::vector<TickRecord> records_;
  std::int64_t dropped_ = 0;
};

/// Sums and extremes of a run.
struct RunTotals {
  std::int64_t ticks = 0;       ///< run
  std::int64_t near = 0;        ///< pair evaluations that were due, summed over ticks
  std::int64_t evaluated = 0;   ///< pair evaluations made
  std::int64_t iterations = 0;  ///< support-map pairs
  std::int64_t stale = 0;       ///< stale answers used, summed over ticks
  int most_stale = 0;           ///< in one tick
  std::int64_t oldest_age = 0;  ///< [ticks]
  double refresh_energy = 0.0;  ///< [J] PairTotals::refresh_energy, summed over ticks
  /// [m] Least signed distance by the measure of the overlap; of all pairs, passable ones included.
  double nearest = std::numeric_limits<double>::infinity();
  PairId nearest_pair;      ///< that of `nearest`
  double deepest = 0.0;     ///< [m] proven bound: none of these pairs was deeper when evaluated
  double peak_force = 0.0;  ///< [N] greatest virtual force on the tool
  double hold_margin = std::numeric_limits<double>::infinity();  ///< [m] least HoldProof::margin
  std::int64_t gaps_left_out = 0;                                ///< HoldProof::left_out, summed
  std::array<std::int64_t, 32> status_ticks{};  ///< ticks in which each status bit was set
  std::array<std::int64_t, 4> stop_ticks{};     ///< ticks in each Stop
  std::int64_t brake_ticks = 0;                 ///< ticks in which the brakes were requested
  std::int64_t unsound = 0;                     ///< ticks with a fault of `status::unsound`
  std::int64_t missing = 0;                     ///< missed ticks
  WorkerReport workers;                         ///< as of the last tick

  /// Adds a tick.
  void add(const TickRecord& r) noexcept;
};

}  // namespace repel
