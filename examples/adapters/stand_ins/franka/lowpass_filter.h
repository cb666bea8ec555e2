// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Stand-in for <franka/lowpass_filter.h> of libfranka: its constants.
#pragma once

namespace franka {

constexpr double kMaxCutoffFrequency = 1000.0;     // [Hz]
constexpr double kDefaultCutoffFrequency = 100.0;  // [Hz]

}  // namespace franka
