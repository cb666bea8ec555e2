// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The operator's side of a scene in each tick.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include <repel/base/setup_error.hpp>
#include <repel/loop/tick.hpp>
#include <repel/network/modules/six_axes.hpp>
#include <repel/network/modules/torque_arm.hpp>
#include <repel/network/network.hpp>
#include <repel/runs/operator/operator_input.hpp>
#include <repel/runs/options/run_options.hpp>
#include <repel/runs/setup/describe.hpp>
#include <repel/runs/wire/remote_values.hpp>
#include <repel/scene/build_network.hpp>

namespace repel::runs {

/// The network on the operator's side, ended by the link.
/// @throws SetupError for an indivisible scene
[[nodiscard]] inline network::Network station_network(const scene::Scene& scene,
                                                      const RunOptions& options,
                                                      network::RemoteLink& link) {
  // Some modules choose their gains for the arm.
  const DescribedScene described = describe(scene, options.rate_hz);
  const network::Plan plan =
      scene::plan_half(scene, scene, described.robots.front().arm, {true, &link});
  try {
    return plan.build(1.0 / options.rate_hz);
  } catch (const SetupError& error) {
    throw scene::located(scene, SetupError(std::string("network: ") + error.what()));
  }
}

/// The operator, the link and the network between them. Allocates only at construction.
class StationSide {
 public:
  /// @param link must outlive this object @param device null: none
  /// @param controls with which a page drives; null: none can
  StationSide(const scene::Scene& scene, const RunOptions& options, network::RemoteLink& link,
              devices::DeviceLink* device, Controls* controls = nullptr)
      : link_(link),
        network_(station_network(scene, options, link)),
        operator_(scene.script, controls, device) {
    operator_.await();
    const network::Vec<network::any_size> none(0);
    signals_.joints = signals_.rates = signals_.mean_rates = signals_.arm_torques = none;
    signals_.jacobian.setZero(6, 0);
    signals_.period = 1.0 / options.rate_hz;
  }

  /// @param now [ns] when the tick is due
  void tick(std::chrono::nanoseconds now, double elapsed) noexcept {
    link_.receive(now);
    site_ = heard_state(link_);
    signals_.elapsed = elapsed;
    signals_.X_WT = site_.X_WT;
    if (is_heard()) operator_.begin();
    const network::Command& command = operator_.step(site_.X_WT.linear(), elapsed);
    tell(command, link_);
    command_ = command;
    if (command.sound && command.hand.is_finite() && command.second.is_finite()) {
      signals_.hand = command.hand;
      signals_.second = command.second;
    } else {
      signals_.hand.rest();
      signals_.second.rest();
    }
    // Nobody holds against the hand: its spring begins anew.
    signals_.at_rest = !is_heard();
    (void)network_.run(signals_);
  }
  /// From now on the hand is at rest and silent.
  void let_go() noexcept { operator_.let_go(); }

  /// The site was heard within the last 0.1 s.
  [[nodiscard]] bool is_heard() const noexcept {
    return link_.is_linked() && link_.silent_for() <= network::WavePlayer::silence;
  }
  /// [N m] Torque of the lever on the hand.
  [[nodiscard]] double felt() const noexcept {
    const auto* lever = network_.find<network::TorqueArm>();
    return lever == nullptr ? 0.0 : lever->felt();
  }
  [[nodiscard]] bool has_handle() const noexcept {
    return network_.find<network::SixAxes>() != nullptr;
  }
  /// [N, N m] Of the motors of a master of six axes; zero if there is none.
  [[nodiscard]] network::Vec<6> felt_at_handle() const noexcept {
    const auto* handle = network_.find<network::SixAxes>();
    return handle == nullptr ? network::Vec<6>::Zero() : handle->felt();
  }
  /// [N, N m] Of the grip of that master on the hand; zero if there is none.
  [[nodiscard]] Wrench grip() const noexcept {
    const auto* handle = network_.find<network::SixAxes>();
    return handle == nullptr ? Wrench{} : network::to_wrench(handle->grip());
  }
  /// The last values from the site.
  [[nodiscard]] const SiteState& site() const noexcept { return site_; }
  [[nodiscard]] std::int32_t phase() const noexcept { return command_.phase; }
  /// Of the operator, in the last tick.
  [[nodiscard]] const network::Command& command() const noexcept { return command_; }
  /// The last state of the site, while it is heard, and that of the station.
  [[nodiscard]] Status status() const noexcept {
    Status bits = is_heard() ? site_.status : status::silent_site;
    if (!command_.sound) bits |= status::bad_command;
    if (command_.is_silent(Teleoperator::patience)) bits |= status::silent_device;
    return bits;
  }
  [[nodiscard]] const network::Network& network() const noexcept { return network_; }

 private:
  network::RemoteLink& link_;
  network::Network network_;
  OperatorInput operator_;
  network::Signals signals_;
  SiteState site_;
  network::Command command_;
};

}  // namespace repel::runs
