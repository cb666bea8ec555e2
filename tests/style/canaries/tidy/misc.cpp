// SPDX-License-Identifier: BSD-3-Clause
// rejected by misc-redundant-expression
bool never(int a) { return a < a; }
