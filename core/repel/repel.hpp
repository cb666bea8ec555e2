// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The kernel in one include: shapes, certified distances, forces, and a world of pairs. It needs
/// Eigen and the standard library, and nothing is linked.
#pragma once

// One message instead of hundreds.
#if __cplusplus < 202002L && (!defined(_MSVC_LANG) || _MSVC_LANG < 202002L)
#error "repel needs C++20: compile with -std=c++20 or newer"
#else

#include <repel/base/capacities.hpp>
#include <repel/base/field.hpp>
#include <repel/base/ids.hpp>
#include <repel/base/layout.hpp>
#include <repel/base/mailbox.hpp>
#include <repel/base/ring.hpp>
#include <repel/base/setup_error.hpp>
#include <repel/base/spatial.hpp>
#include <repel/base/status.hpp>
#include <repel/base/types.hpp>
#include <repel/distance/gjk.hpp>
#include <repel/force/law.hpp>
#include <repel/force/passage.hpp>
#include <repel/geometry/box_tree.hpp>
#include <repel/geometry/triangle_mesh.hpp>
#include <repel/pairs/pairs.hpp>
#include <repel/reduction/separation.hpp>
#include <repel/reduction/shape.hpp>
#include <repel/reduction/shape_mesh.hpp>
#include <repel/world/arm.hpp>
#include <repel/world/kinematics.hpp>
#include <repel/world/world.hpp>

#endif
