// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What every simulated arm is and what its engine does for it; options, faults and set-up checks.
#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <repel/simulated/arm_drive.hpp>
#include <repel/simulated/built_alike.hpp>
#include <repel/simulated/contact_tally.hpp>
#include <repel/world/arm.hpp>

namespace repel {

/// How an engine steps, and how stiff the joint stops and physical contacts are.
struct SimulationOptions {
  int substeps = 4;                ///< equal parts of one `step`; 1 to 1000
  double stop_stiffness = 1e5;     ///< [N m/rad] or [N/m] of a joint stop; >= 0
  double stop_damping = 1e3;       ///< [N m s/rad] or [N s/m] while moving into a stop; >= 0
  double contact_stiffness = 1e6;  ///< [N/m] of a contact point; 0 to 1e12
  double contact_damping = 1e4;    ///< [N s/m] of contacts; never pulls; 1e-3 to 1e12
  double contact_friction = 0.5;   ///< friction force as a share of the normal force; 0 to 1e3
  double watchdog = 0.0;  ///< [s] timeout without torques after which the arm stops; 0: never
};

/// Input rejected by a simulated arm since construction or since its faults were cleared.
struct SimulationFaults {
  bool torque = false;  ///< an entry was missing or not usable and was taken as zero
  bool period = false;  ///< a period was not finite or not positive: the arm did not move
  bool state = false;   ///< the motion diverged: the arm was stopped where it was; lower the
                        ///< torques or raise SimulationOptions::substeps
};

/// Throws SetupError naming the joint and the number of `model` beyond every engine: a pose not
/// rigid, an axis not of unit length, a mass, friction or inertia negative or not finite, limits
/// out of order. Set-up only, as all below.
void require_simulable(const ArmModel& model);

/// Throws SetupError naming an option out of its range.
void require_valid(const SimulationOptions& options);

/// Throws SetupError unless `q` [rad] or [m] and `v` [rad/s] or [m/s] (or empty) are finite, one
/// for each link, and `q` within the limits.
void require_state(const ArmModel& model, std::span<const double> q, std::span<const double> v);

/// The positions in which an arm starts: zero, or the joint limit nearest to it [rad] or [m].
[[nodiscard]] std::vector<double> start_of(const ArmModel& model);

/// The equations of motion of one arm, as an engine solves them. A new engine derives from this
/// class, and its arm from SimulatedArm. Spans have one entry per link, base outward.
class ArmEngine {
 public:
  /// @param model of the arm; its limits are those of a reset
  /// @param most_torque [N m] or [N] the engine can be given; more is a fault
  explicit ArmEngine(ArmModel model,
                     double most_torque = std::numeric_limits<double>::max()) noexcept;
  virtual ~ArmEngine() = default;
  ArmEngine(const ArmEngine&) = delete;
  ArmEngine& operator=(const ArmEngine&) = delete;

  /// Puts the arm at `q` [rad] or [m], moving at `v` [rad/s] or [m/s], or at rest if that is empty.
  /// Ends all contacts.
  virtual void put(std::span<const double> q, std::span<const double> v) noexcept = 0;

  /// Moves the arm by `h` [s].
  /// @param torque [N m] or [N]; zero while the brakes are on
  /// @return false if the motion diverged: the arm is at rest then, at finite positions
  [[nodiscard]] virtual bool sub_step(std::span<const double> torque, bool braked,
                                      double h) noexcept = 0;

  [[nodiscard]] virtual std::span<const double> q() const noexcept = 0;  ///< [rad] or [m]
  [[nodiscard]] virtual std::span<const double> v() const noexcept = 0;  ///< [rad/s] or [m/s]

  [[nodiscard]] const ArmModel& model() const noexcept { return model_; }     ///< of the arm
  [[nodiscard]] double most_torque() const noexcept { return most_torque_; }  ///< [N m] or [N]
  [[nodiscard]] ContactTally& contacts() noexcept { return contacts_; }       ///< of its sub-steps

 private:
  ArmModel model_;
  double most_torque_;
  ContactTally contacts_;
};

/// An arm with a drive and brakes, moved by an engine. Deterministic: the same calls give bitwise
/// the same motion. One thread at a time. A moved-from arm may only be assigned to or destroyed.
class SimulatedArm : public TorqueDrivenArm {
 public:
  /// Number of links, equal to the number of joints.
  [[nodiscard]] int links() const noexcept { return static_cast<int>(torque_.size()); }

  /// Puts the arm at `q` [rad] or [m], moving at `v` [rad/s] or [m/s] (at rest if `v` is empty),
  /// enabled, with zero torque and a cleared contact report. Faults stay.
  /// @throws SetupError if a size is wrong, `q` is outside the limits or `v` is not finite
  void reset(std::span<const double> q, std::span<const double> v = {});

  /// Joint torques [N m] or forces [N], held until the next call. An entry that is missing, not
  /// finite or more than the engine can be given counts as zero and sets a fault.
  void set_torques(std::span<const double> torques) noexcept override;

  /// Advances the arm by `period` [s]. A period that is not finite and positive does nothing and
  /// sets a fault. Cost grows with substeps x links^3.
  void step(double period) noexcept override;

  /// Enables the arm: torques act and the brakes are off. This is the initial state.
  void enable() noexcept override { drive_.enable(); }

  /// Stops the arm: no torque acts and the brakes are on, until `enable`. The watchdog of the
  /// options does the same if no torques are set for its timeout, in simulated time.
  void stop() noexcept override;

  /// Brakes on or off while the arm is enabled; no torque acts while they are on.
  void engage_brakes(bool on) noexcept override { drive_.engage_brakes(on); }

  /// Whether torques act, or it has been stopped.
  [[nodiscard]] ArmState state() const noexcept override { return drive_.state(); }

  /// Joint positions [rad] or [m]; fills as many as `out` holds.
  void read_positions(std::span<double> out) const noexcept override;

  /// Joint velocities [rad/s] or [m/s]; fills as many as `out` holds.
  void read_velocities(std::span<double> out) const noexcept override;

  /// Contacts since the last reset.
  [[nodiscard]] ContactReport contact() const noexcept override {
    return engine_->contacts().report();
  }

  /// The sum of all contact forces on the parts of the last link, mean of the sub-steps of the last
  /// step; zero without parts. The weight of the tool is not part of it.
  [[nodiscard]] std::optional<Wrench> read_wrench() const noexcept override {
    return engine_->contacts().on_tool();
  }

  /// What it has rejected since construction or `clear_faults`.
  [[nodiscard]] SimulationFaults faults() const noexcept { return faults_; }
  /// Forgets these faults.
  void clear_faults() noexcept { faults_ = {}; }

 protected:
  /// Starts at rest, as `start_of` says.
  /// @param engine not null @param substeps >= 1 @param watchdog [s] see ArmDrive
  SimulatedArm(std::unique_ptr<ArmEngine> engine, int substeps, double watchdog);

  [[nodiscard]] const ArmEngine& engine() const noexcept { return *engine_; }  ///< what moves it
  [[nodiscard]] ArmEngine& engine() noexcept { return *engine_; }              ///< likewise

 private:
  std::unique_ptr<ArmEngine> engine_;
  int substeps_;
  ArmDrive drive_;
  std::vector<double> torque_, no_torque_;  // [N m] or [N]
  SimulationFaults faults_;
};

}  // namespace repel
