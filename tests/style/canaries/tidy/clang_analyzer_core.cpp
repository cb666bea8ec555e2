// SPDX-License-Identifier: BSD-3-Clause
// rejected by clang-analyzer-core.NullDereference
int read() {
  int* nothing = nullptr;
  return *nothing;
}
