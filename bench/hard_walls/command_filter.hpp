// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What others do to hold a tool off: the commanded twist is changed before it is followed.
#pragma once

#include <span>

#include <repel/loop/barrier/hard_contacts.hpp>

#include "setting.hpp"

namespace repel::hard_walls {

/// Changes what the hand of the arm with this `tool` commands [m/s, rad/s].
void filter_command(Way way, std::span<const HardContact> gaps, BodyId tool, Twist& V);

}  // namespace repel::hard_walls
