// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A library that has a type of repel in its interface, and a part of it inside.
#pragma once

#include <repel/base/types.hpp>

namespace parent {

/// Records a velocity and a force, [m/s] and [N], in a file; its power [W].
double record(const repel::Vec3& velocity, const repel::Vec3& force, const char* path);

}  // namespace parent
