// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What the samples of docs/devices.md leave out.
#pragma once

#include <repel/devices/device_thread.hpp>
#include <repel/devices/hand_follower.hpp>
#include <repel/devices/spacenav.hpp>
#include <repel/network/modules.hpp>

using namespace repel;
using namespace repel::devices;
extern network::Signals signals;
extern const double period;
extern const double lever_torque;
extern const Wrench tool_force;
