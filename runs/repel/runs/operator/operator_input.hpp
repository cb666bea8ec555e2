// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The operator of an arm: a script, a page, a device, or a recording.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>

#include <repel/loop/record.hpp>
#include <repel/network/operator.hpp>
#include <repel/runs/operator/controls.hpp>
#include <repel/runs/operator/device.hpp>
#include <repel/runs/options/hand_track.hpp>
#include <repel/visual/page_command.hpp>

#ifdef REPEL_RUNS_DEVICES
#include <repel/devices/device_thread.hpp>
#include <repel/devices/hand_follower.hpp>
#endif

namespace repel::runs {

/// Plays the script by default. Once a page has taken control, the script is over: the hand follows
/// the last post, and rests while nobody drives. A device drives from the start; a page can
/// override it for a while if the controls allow it.
class OperatorInput {
 public:
  static constexpr double rest_after = visual::PageCommand::rest_after;
  static constexpr double silent_after = visual::PageCommand::silent_after;

  /// @param controls null: no page can drive
  /// @param device null: none
  explicit OperatorInput(network::Script script, Controls* controls = nullptr,
                         devices::DeviceLink* device = nullptr)
      : script_(std::move(script)), device_(device) {
    if (controls != nullptr) {
      page_.emplace(*controls);
      over_device_ = controls->over_device;
    }
    if (device_ != nullptr) driver_ = Driver::device;
  }

  /// From now on replays the command of `record`, which must stay valid and is read at each tick.
  void follow(const TickRecord& record) noexcept { recorded_ = &record; }

  /// From now on does in place of the script what the track says, which must stay valid.
  void follow(const HandTrack& track) noexcept { track_ = &track; }

  /// From now on the command there, while there is one, counts in place of all others. It is read
  /// at each tick, and must stay valid.
  void obey(const std::optional<network::Command>& told) noexcept { told_ = &told; }

  /// The script begins at `begin`: until then the hand is at rest.
  void await() noexcept { awaits_ = true; }
  void begin() noexcept { awaits_ = false; }

  /// From now on the hand is at rest and silent, whoever drives: the fail-safe fades the forces.
  void let_go() noexcept { has_let_go_ = true; }

  [[nodiscard]] const network::Command& step(const Mat3& R_WT, double period) noexcept {
    if (recorded_ != nullptr) {
      command_ = recorded_->command;
    } else if (has_let_go_) {
      rest(period);
    } else if (told_ != nullptr && *told_) {
      command_ = **told_;
    } else {
      const bool listens = hear(period);
      if (device_ != nullptr) feel(period, listens);
      if (listens) listen(R_WT);
      if (driver_ == Driver::script && !awaits_) {
        if (track_ == nullptr) {
          command_ = script_.step(R_WT, period);
        } else {
          track_->read(time_, command_);
          time_ += period;
        }
      }
    }
    command_.phase = static_cast<std::int32_t>(phase());
    return command_;
  }

  [[nodiscard]] std::size_t phase() const noexcept {
    if (recorded_ != nullptr) return static_cast<std::size_t>(recorded_->phase);
    const bool is_scripted = driver_ == Driver::script && track_ == nullptr;
    return is_scripted ? script_.phase() : script_.script().size();
  }

 private:
  /// Keeps the direction of the lever, so that the force of its spring does not change direction.
  void rest(double period) noexcept {
    command_.hand.rest();
    command_.second.rest();
    command_.sound = true;
    command_.silent_for = std::max(silent_after, command_.silent_for + period);
  }

  /// True while the controls, and not the device, determine the command.
  bool hear(double period) noexcept {
    if (!page_) return false;
    page_->hear(period);
    if (device_ == nullptr) return true;
    return over_device_ && page_->driver() == Driver::page;
  }

  void listen(const Mat3& R_WT) noexcept {
    driver_ = page_->driver();
    page_->write(R_WT, command_);
  }

  /// A device reports itself whether it is silent; it then counts as at rest. It is also read while
  /// a page drives, so that no old data counts when the device takes over again.
  void feel(double period, bool taken) noexcept {
#ifdef REPEL_RUNS_DEVICES
    const devices::Measured& m = device_->measured(period);
    if (taken) return follower_.rest();
    driver_ = Driver::device;
    command_.second.rest();
    command_.sound = true;
    command_.hand.ball = follower_.step(m, period);
    command_.hand.lever_rate = m.lever_rate;
    if (m.lever_rate != 0.0) {
      command_.hand.direction_W = m.lever_direction_W;
      command_.hand.turning_W = Vec3::Zero();
    }
    command_.silent_for = m.silent ? std::max(silent_after, device_->silent_for()) : 0.0;
#else
    (void)period;
    (void)taken;
#endif
  }

  network::ScriptedOperator script_;
  std::optional<visual::PageCommand> page_;  ///< none: no page can drive
  bool over_device_ = false;
  devices::DeviceLink* device_;
#ifdef REPEL_RUNS_DEVICES
  devices::HandFollower follower_;
#endif
  const TickRecord* recorded_ = nullptr;
  const HandTrack* track_ = nullptr;
  double time_ = 0.0;  ///< [s] since the track began
  const std::optional<network::Command>* told_ = nullptr;
  Driver driver_ = Driver::script;
  network::Command command_;
  bool has_let_go_ = false;
  bool awaits_ = false;
};

}  // namespace repel::runs
