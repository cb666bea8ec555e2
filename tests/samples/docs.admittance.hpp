// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What the samples of docs/admittance.md leave out.
#pragma once

#include <repel/control.hpp>
#include <repel/repel.hpp>

using namespace repel;
extern CellDescription description;
extern ArmDescription arm;
extern const double period;
extern const ArmReadings readings;
extern const network::Command hands;
extern const std::chrono::nanoseconds now;
void send(std::span<const double> positions);
