// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The code that evaluates pairs, compiled for one instruction set.
#pragma once

#include <repel/schedule/any_pair_set.hpp>
#include <repel/schedule/separations.hpp>

namespace repel::detail {

/// The entries into that code: what follows them is known to nobody else.
struct Evaluators {
  const char* instruction_set;
  std::unique_ptr<AnyPairSet> (*make_pair_set)(const World& world, int slots, const Budget& budget,
                                               double lookahead);
  void (*separations)(std::span<const PosedShapes> pairs, const QueryOptions& options,
                      std::span<WarmStart> warm, std::span<Separation> results) noexcept;
};

/// Those that both this library and the processor have, the fastest last.
std::span<const Evaluators* const> all_evaluators() noexcept;

}  // namespace repel::detail
