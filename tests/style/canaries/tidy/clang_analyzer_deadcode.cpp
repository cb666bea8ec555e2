// SPDX-License-Identifier: BSD-3-Clause
// rejected by clang-analyzer-deadcode.DeadStores
int next(int a) {
  int b = a + 1;
  b = a + 2;
  b = a + 3;
  return b;
}
