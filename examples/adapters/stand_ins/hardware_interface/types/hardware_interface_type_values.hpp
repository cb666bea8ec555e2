// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Stand-in for the header of this name of ros2_control.
#pragma once

namespace hardware_interface {

constexpr char HW_IF_POSITION[] = "position";
constexpr char HW_IF_VELOCITY[] = "velocity";
constexpr char HW_IF_EFFORT[] = "effort";

}  // namespace hardware_interface
