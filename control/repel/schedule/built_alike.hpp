// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A program compiled for other registers than this library does not link (base/layout.hpp).
#pragma once

#include <repel/base/layout.hpp>

namespace repel::control {

/// Defined for the flags that this library was compiled with, and for no others.
void is_built_for(EigenAlignmentHere, VectorRegisterHere) noexcept;
/// Makes the program link `is_built_for`.
[[gnu::used, gnu::retain]] constexpr auto built_alike = &is_built_for;

}  // namespace repel::control
