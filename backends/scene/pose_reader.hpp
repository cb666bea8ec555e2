// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Reads positions and poses of a scene file.
#pragma once

#include <repel/base/types.hpp>
#include <repel/reduction/shape.hpp>

#include "units.hpp"
#include "yaml.hpp"

namespace repel::scene::detail {

inline constexpr Rule position{unit::length, -Shape::largest, Shape::largest};
inline constexpr Rule angles{unit::angle, -1e3, 1e3};

/// Rotations about the fixed axes x, then y, then z [rad], as in URDF.
[[nodiscard]] Mat3 rotation_of(const Vec3& rpy);

/// From the keys `position` and `rpy`, each of which may be missing.
[[nodiscard]] Pose pose_of(const Map& map);

}  // namespace repel::scene::detail
