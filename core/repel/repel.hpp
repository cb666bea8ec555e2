/// @file
/// Everything of the core in one include.
#pragma once

#include <repel/base/ids.hpp>
#include <repel/base/limits.hpp>
#include <repel/base/mailbox.hpp>
#include <repel/base/setup_error.hpp>
#include <repel/base/spatial.hpp>
#include <repel/base/status.hpp>
#include <repel/base/types.hpp>
#include <repel/distance/gjk.hpp>
#include <repel/force/law.hpp>
#include <repel/force/passage.hpp>
#include <repel/geometry/box_tree.hpp>
#include <repel/loop/gain_check.hpp>
#include <repel/loop/shuttle.hpp>
#include <repel/loop/tick.hpp>
#include <repel/network/clean_stiffness.hpp>
#include <repel/network/operator.hpp>
#include <repel/network/plan.hpp>
#include <repel/reduction/separation.hpp>
#include <repel/reduction/shape.hpp>
#include <repel/schedule/coprocessor.hpp>
#include <repel/schedule/deadline.hpp>
#include <repel/world/arm.hpp>
#include <repel/world/simulated_arm.hpp>
#include <repel/world/world.hpp>
