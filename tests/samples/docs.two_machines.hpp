// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What the samples of docs/two_machines.md leave out.
#pragma once

#include <repel/control.hpp>
#include <repel/link/link_thread.hpp>
#include <repel/link/udp.hpp>
#include <repel/repel.hpp>

using namespace repel;
extern const std::uint64_t random_number;
extern const std::uint64_t hash_of_what_both_share;
extern Cell cell;
extern const ArmReadings readings;
extern const network::Command hands;
extern const std::chrono::nanoseconds now;
