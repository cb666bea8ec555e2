// SPDX-License-Identifier: BSD-3-Clause
// The functions of the cell, compiled once.
#ifndef REPEL_COMPILED
#error "compile this file, and every other one of the program, with -DREPEL_COMPILED"
#endif
#define REPEL_CELL_DEFINITIONS
#include <repel/cell/cell.hpp>

void repel::compiled::is_built_for(EigenAlignmentHere /*alignment*/,
                                   VectorRegisterHere /*size*/) noexcept {}
