/// @file
/// Everything of the core in one include.
#pragma once

#include <repel/base/setup_error.hpp>
#include <repel/base/spatial.hpp>
#include <repel/base/types.hpp>
#include <repel/world/arm.hpp>
