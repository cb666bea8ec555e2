// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The machine around the kernel in one include: threads, network, control loop and cell. It is
/// compiled: link the target `repel::control`.
#pragma once

#include <repel/cell/admittance.hpp>
#include <repel/cell/arm_port.hpp>
#include <repel/cell/cell.hpp>
#include <repel/cell/layout.hpp>
#include <repel/cell/servo_response.hpp>
#include <repel/cell/stability_budget.hpp>
#include <repel/loop/gain_check.hpp>
#include <repel/loop/reciprocating_motion.hpp>
#include <repel/loop/tap.hpp>
#include <repel/loop/tick.hpp>
#include <repel/network/machinery/clean_stiffness.hpp>
#include <repel/network/modules.hpp>
#include <repel/network/operator.hpp>
#include <repel/network/plan.hpp>
#include <repel/network/remote/link.hpp>
#include <repel/schedule/coprocessor.hpp>
#include <repel/schedule/instruction_set.hpp>
#include <repel/schedule/separations.hpp>
#include <repel/schedule/world_changes.hpp>
