// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Prevents linking with a program that was compiled with another type layout.
#pragma once

#include <repel/base/layout.hpp>

namespace repel::simulated {

/// Defined for the compiler flags of this library: a program with incompatible flags does not link.
void is_built_for(EigenAlignmentHere, VectorRegisterHere) noexcept;
/// Makes the program link `is_built_for`.
[[gnu::used, gnu::retain]] constexpr auto built_alike = &is_built_for;

}  // namespace repel::simulated
