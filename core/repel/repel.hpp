// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The core in one include. With `REPEL_COMPILED` without what a cell links then: the rooms `loop`,
/// `pairs` and `schedule`.
#pragma once

// One message instead of hundreds.
#if __cplusplus < 202002L && (!defined(_MSVC_LANG) || _MSVC_LANG < 202002L)
#error "repel needs C++20: compile with -std=c++20 or newer"
#else

#include <repel/base/capacities.hpp>
#include <repel/base/complaint.hpp>
#include <repel/base/ids.hpp>
#include <repel/base/input_limits.hpp>
#include <repel/base/layout.hpp>
#include <repel/base/mailbox.hpp>
#include <repel/base/ring.hpp>
#include <repel/base/setup_error.hpp>
#include <repel/base/spatial.hpp>
#include <repel/base/status.hpp>
#include <repel/base/text_file.hpp>
#include <repel/base/types.hpp>
#include <repel/cell/admittance.hpp>
#include <repel/cell/arm_port.hpp>
#include <repel/cell/cell.hpp>
#include <repel/distance/gjk.hpp>
#include <repel/force/law.hpp>
#include <repel/force/passage.hpp>
#include <repel/geometry/box_tree.hpp>
#include <repel/geometry/triangle_mesh.hpp>
#include <repel/loop/reciprocating_motion.hpp>
#include <repel/network/machinery/clean_stiffness.hpp>
#include <repel/network/modules.hpp>
#include <repel/network/operator.hpp>
#include <repel/network/plan.hpp>
#include <repel/reduction/separation.hpp>
#include <repel/reduction/shape.hpp>
#include <repel/reduction/shape_mesh.hpp>
#include <repel/schedule/deadline.hpp>
#include <repel/world/arm.hpp>
#include <repel/world/arm_kinematics.hpp>
#include <repel/world/changed_arm.hpp>
#include <repel/world/contact.hpp>
#include <repel/world/delayed_arm.hpp>
#include <repel/world/sensed_arm.hpp>
#include <repel/world/simulated_arm.hpp>
#include <repel/world/world.hpp>

#ifndef REPEL_COMPILED
#include <repel/loop/gain_check.hpp>
#include <repel/loop/tap.hpp>
#include <repel/loop/tick.hpp>
#include <repel/schedule/coprocessor.hpp>
#include <repel/schedule/world_changes.hpp>
#endif

#endif
