/// @file
/// A canary.
#pragma once

#include <cmath>

#include <Eigen/Core>
#include <repel/base/other.hpp>
