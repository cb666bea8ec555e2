/// @file
/// Keeps a program with another layout of types than this part from linking it.
#pragma once

#include <repel/base/layout.hpp>

namespace repel::robots {

/// Defined for the flags this part was built with: a program with others does not link.
void is_built_for(EigenAlignmentHere, VectorRegisterHere) noexcept;
[[gnu::used, gnu::retain]] constexpr auto built_alike = &is_built_for;

}  // namespace repel::robots
