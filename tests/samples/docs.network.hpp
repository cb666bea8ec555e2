// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What the samples of docs/network.md leave out.
#pragma once

#include <repel/control.hpp>
#include <repel/repel.hpp>

using repel::network::JointLimits;
extern const std::vector<repel::network::JointRange> ranges;
