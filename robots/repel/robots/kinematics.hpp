// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Kinematics stand in the kernel: for programs that include them from here.
#pragma once

#include <repel/world/kinematics.hpp>
