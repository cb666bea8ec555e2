// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The instruction set for which the evaluation of pairs is compiled, chosen when a program starts.
#pragma once

#include <span>
#include <string_view>

namespace repel {

/// The name of the instruction set in use, "x86-64", "x86-64-v3" or "x86-64-v4", or of another
/// processor that for which this library was compiled. It is the last of `instruction_sets()`,
/// unless the environment variable REPEL_ISA names another one of them. Distances and forces have
/// the same bits in all of them.
/// @throws SetupError where REPEL_ISA names one that this library or the processor has not
std::string_view instruction_set();

/// Those that both this library and the processor have, the fastest last.
std::span<const std::string_view> instruction_sets() noexcept;

}  // namespace repel
