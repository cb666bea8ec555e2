// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The distances of many pairs of shapes in one call.
#pragma once

#include <span>

#include <repel/distance/query.hpp>
#include <repel/reduction/convex_shape.hpp>
#include <repel/reduction/separation_result.hpp>

namespace repel {

/// Two shapes at their poses, for the length of a call.
struct PosedShapes {
  PosedShape a;  ///< one of them
  PosedShape b;  ///< the other
};

/// `separation` of each of `pairs`, with the code for the instruction set in use
/// (repel/schedule/instruction_set.hpp), and with the same bits. Bounded; allocates nothing.
/// @param warm what each query leaves for the next on the same pair, of the length of `pairs`; or
/// empty: all begin cold
/// @param results of the length of `pairs`
/// Where lengths differ, the shortest counts. Cost: that of the queries.
void separations(std::span<const PosedShapes> pairs, const QueryOptions& options,
                 std::span<WarmStart> warm, std::span<Separation> results) noexcept;

}  // namespace repel
