// SPDX-License-Identifier: BSD-3-Clause
// rejected by misc-no-recursion
int down(int n) { return n > 0 ? down(n - 1) : 0; }
