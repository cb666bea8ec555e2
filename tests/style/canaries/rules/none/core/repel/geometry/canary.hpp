// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A canary.
#pragma once

#include <cmath>

#include <Eigen/Core>
#include <repel/base/other.hpp>
