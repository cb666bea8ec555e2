/// @file
/// The modules that come with the library.
#pragma once

#include <repel/network/arm_obstacle.hpp>
#include <repel/network/kbb2.hpp>
#include <repel/network/limits.hpp>
#include <repel/network/line.hpp>
#include <repel/network/multiplex.hpp>
#include <repel/network/obstacle.hpp>
#include <repel/network/one_ports.hpp>
#include <repel/network/puma_joints.hpp>
#include <repel/network/puma_kin.hpp>
#include <repel/network/relief.hpp>
#include <repel/network/spaceball.hpp>
#include <repel/network/torque_arm.hpp>
#include <repel/network/visual.hpp>
