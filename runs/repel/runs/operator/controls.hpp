// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// User control of a run: that of the live view, whether it is built in or not.
#pragma once

#include <repel/visual/controls.hpp>

namespace repel::runs {

using visual::Controls;
using visual::Driver;
using visual::DriverInput;

}  // namespace repel::runs
