// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What the samples of docs/network/elements.md leave out.
#pragma once

#include <repel/control.hpp>
#include <repel/repel.hpp>

using namespace repel::network;
extern const std::uint64_t random_number;
extern const std::uint64_t hash_of_what_both_share;
extern const std::chrono::nanoseconds now;
extern const Signals signals;
