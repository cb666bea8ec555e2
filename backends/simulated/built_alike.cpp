// SPDX-License-Identifier: BSD-3-Clause
#include <repel/simulated/built_alike.hpp>

namespace repel::simulated {

void is_built_for(EigenAlignmentHere /*alignment*/, VectorRegisterHere /*size*/) noexcept {}

}  // namespace repel::simulated
