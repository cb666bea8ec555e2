// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>

#include <parent.hpp>

int main() {
  const double power = parent::record({1.0, 2.0, 3.0}, {4.0, 5.0, 6.0}, "/dev/null");
  std::printf("%g W\n", power);
  return power == 32.0 ? 0 : 1;
}
