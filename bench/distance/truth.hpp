/// @file
/// Exact distances and penetration depths of polytopes, built on the oracles of the
/// tests.
#pragma once

#include <repel/base/types.hpp>
#include <support/families.hpp>

namespace repel::bench {

/// [m] The distance of two polytopes that are apart, to 1e-15 of their size; 0 when they meet.
/// Throws std::runtime_error when 113 bits cannot prove it.
[[nodiscard]] double exact_gap(const families::Solid& A, const Pose& X_WA, const families::Solid& B,
                               const Pose& X_WB);

/// [m] The penetration depth of two polytopes of at most 32 vertices; not positive when they are
/// apart. Throws std::runtime_error when one has no volume.
[[nodiscard]] double exact_depth(const families::Solid& A, const Pose& X_WA,
                                 const families::Solid& B, const Pose& X_WB);

}  // namespace repel::bench
