// SPDX-License-Identifier: BSD-3-Clause
#include <repel/schedule/built_alike.hpp>

namespace repel::control {

void is_built_for(EigenAlignmentHere /*alignment*/, VectorRegisterHere /*size*/) noexcept {}

}  // namespace repel::control
