// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The readings of an arm, as a tick takes them.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <repel/base/spatial.hpp>
#include <repel/network/elements/signals.hpp>
#include <repel/network/modules/force_sensor.hpp>

namespace repel {

/// Copies the readings `from` an arm; missing entries read as NaN.
void copy_readings(std::span<const double> from, std::vector<double>& to) noexcept;

/// Gives a network with a force sensor its reading, and the inertia of the arm in `signals` as the
/// modules on its left move it.
void pass_wrench(const std::optional<Wrench>& reading, const network::ForceSensor& sensor,
                 network::Signals& signals) noexcept;

}  // namespace repel
