/// @file
/// The operator of an arm: a script until somebody takes the controls, a device, or a recording.
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>

#include <repel/loop/record.hpp>
#include <repel/network/operator.hpp>

#ifdef REPEL_TELEOP_DEVICES
#include <repel/devices/device_thread.hpp>
#endif

#include "controls.hpp"
#include "device.hpp"

namespace repel::teleop {

/// A network::Operator. With nothing else it plays its script. Once somebody has taken the controls
/// the script is over: the hand does what the last post says, or rests while nobody drives. A
/// device has the controls from the beginning; where the controls say so a page can have them from
/// it for a while.
class Hands {
 public:
  /// [s] A driver of whom nothing was heard for so long is taken to rest, and then to be silent, at
  /// which the fail-safe lets go. Whoever drives speaks ten times a second or more.
  static constexpr double rest_after = 0.1;
  static constexpr double silent_after = 0.25;

  /// @param controls null: nobody can take them
  /// @param device null: there is none
  explicit Hands(network::Script script, Controls* controls = nullptr,
                 devices::DeviceLink* device = nullptr)
      : script_(std::move(script)), controls_(controls), device_(device) {
    if (device_ != nullptr) driver_ = Driver::device;
  }

  /// From now on what `record`, which must stand, says at each tick.
  void follow(const TickRecord& record) noexcept { recorded_ = &record; }

  /// From now on they rest and are silent, whoever drives: the fail-safe fades the forces.
  void let_go() noexcept { has_let_go_ = true; }

  [[nodiscard]] const network::Command& step(const Mat3& R_WT, double period) noexcept {
    if (recorded_ != nullptr) return recorded_->command;
    if (has_let_go_) {
      rest(period);
      return command_;
    }
    const bool listens = hear(period);
    if (device_ != nullptr) feel(period, listens);
    if (listens) listen(R_WT);
    if (driver_ == Driver::script) command_ = script_.step(R_WT, period);
    return command_;
  }

  [[nodiscard]] std::size_t phase() const noexcept {
    if (recorded_ != nullptr) return static_cast<std::size_t>(recorded_->phase);
    return driver_ == Driver::script ? script_.phase() : script_.script().size();
  }

 private:
  /// The lever keeps its direction: what its spring holds goes no other way.
  void rest(double period) noexcept {
    command_.hand.ball = {};
    command_.hand.lever_rate = 0.0;
    command_.sound = true;
    command_.silent_for = std::max(silent_after, command_.silent_for + period);
  }

  /// True while it is not the device that has the controls.
  bool hear(double period) noexcept {
    if (controls_ == nullptr) return false;
    const bool heard = controls_->grip.take();
    unheard_ = heard ? 0.0 : unheard_ + period;
    if (device_ == nullptr) return true;
    return controls_->over_device && controls_->grip.newest().driver == Driver::page;
  }

  void listen(const Mat3& R_WT) noexcept {
    const Grip& grip = controls_->grip.newest();
    driver_ = grip.driver;
    // Rates in the axes of the tool turn with it from tick to tick.
    command_.hand.ball = grip.in_tool ? rotated(R_WT, grip.rates) : grip.rates;
    command_.hand.lever_rate = grip.lever_rate;
    command_.sound = is_finite(grip.rates) && is_finite(grip.direction_W) &&
                     grip.lever_rate - grip.lever_rate == 0.0;
    if (command_.sound) command_.hand.direction_W = grip.direction_W;
    if (!command_.sound || unheard_ > rest_after) {
      command_.hand.ball = {};
      command_.hand.lever_rate = 0.0;
    }
    command_.silent_for = driver_ == Driver::page && unheard_ > silent_after ? unheard_ : 0.0;
  }

  /// A device says itself when it is silent, and then it is at rest. It is read while a page has
  /// the controls too: what is old must not count when it gets them back.
  void feel(double period, bool taken) noexcept {
#ifdef REPEL_TELEOP_DEVICES
    const devices::Measured& m = device_->measured(period);
    if (taken) return;
    driver_ = Driver::device;
    command_.sound = true;
    command_.hand.ball = m.measured_cv;
    command_.hand.lever_rate = m.lever_rate;
    if (m.lever_rate != 0.0) command_.hand.direction_W = m.lever_direction_W;
    command_.silent_for = m.silent ? std::max(silent_after, device_->silent_for()) : 0.0;
#else
    (void)period;
    (void)taken;
#endif
  }

  network::ScriptedOperator script_;
  Controls* controls_;
  devices::DeviceLink* device_;
  const TickRecord* recorded_ = nullptr;
  Driver driver_ = Driver::script;
  network::Command command_;
  double unheard_ = 0.0;  ///< [s] since the last post
  bool has_let_go_ = false;
};

}  // namespace repel::teleop
