// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A canary: it leads to base/other.hpp through the other one.
#pragma once

#include <repel/geometry/canary.hpp>
