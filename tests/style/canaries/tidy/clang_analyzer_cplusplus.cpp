// SPDX-License-Identifier: BSD-3-Clause
// rejected by clang-analyzer-cplusplus.NewDelete
int read() {
  int* number = new int(1);
  delete number;
  return *number;
}
