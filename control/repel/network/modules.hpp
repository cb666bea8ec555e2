// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The modules that come with the library.
#pragma once

#include <repel/network/elements/junction.hpp>
#include <repel/network/elements/line.hpp>
#include <repel/network/elements/one_ports.hpp>
#include <repel/network/modules/arm_obstacle.hpp>
#include <repel/network/modules/force_sensor.hpp>
#include <repel/network/modules/guide.hpp>
#include <repel/network/modules/kbb2.hpp>
#include <repel/network/modules/limits.hpp>
#include <repel/network/modules/multiplex.hpp>
#include <repel/network/modules/obstacle.hpp>
#include <repel/network/modules/posture.hpp>
#include <repel/network/modules/puma_joints.hpp>
#include <repel/network/modules/puma_kin.hpp>
#include <repel/network/modules/relief.hpp>
#include <repel/network/modules/six_axes.hpp>
#include <repel/network/modules/spaceball.hpp>
#include <repel/network/modules/torque_arm.hpp>
#include <repel/network/modules/visual.hpp>
#include <repel/network/remote/remote_line.hpp>
