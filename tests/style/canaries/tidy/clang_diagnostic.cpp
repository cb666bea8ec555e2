// SPDX-License-Identifier: BSD-3-Clause
// rejected by clang-diagnostic-unused-variable
void idle() { int unused = 1; }
