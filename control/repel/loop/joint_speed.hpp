// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Keeps joints within their speed limits.
#pragma once

namespace repel {

/// The part of a torque `asked` [N m] that is allowed for a joint that moves at `v` [rad/s] with
/// speed limit `limit` (0 or infinite: none is known): all of it while it brakes; while it drives,
/// a factor that falls linearly to zero over the last fifth below the limit. It only removes power,
/// so passivity is preserved. The motion of other joints can still carry a joint past its limit.
[[nodiscard]] double within_speed(double asked, double v, double limit) noexcept;

}  // namespace repel
