// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Exact distances and penetration depths of polytopes, computed by the oracles of the tests.
#pragma once

#include <repel/base/types.hpp>
#include <support/families.hpp>

namespace repel::bench {

/// [m] The distance of two separated polytopes, to 1e-15 of their size; 0 if they intersect. Throws
/// std::runtime_error if 113-bit arithmetic cannot prove it.
[[nodiscard]] double exact_gap(const families::Solid& A, const Pose& X_WA, const families::Solid& B,
                               const Pose& X_WB);

/// [m] The penetration depth of two polytopes of at most 32 vertices; not positive if they are
/// apart. Throws std::runtime_error if one has no volume.
[[nodiscard]] double exact_depth(const families::Solid& A, const Pose& X_WA,
                                 const families::Solid& B, const Pose& X_WB);

}  // namespace repel::bench
