// SPDX-License-Identifier: BSD-3-Clause
// An external program: all of the core in two translation units that are linked together.
#include <cstdio>

#include <repel/repel.hpp>

double power_elsewhere(const repel::Wrench& F, const repel::Twist& V);

#ifdef PART_visual
bool page_is_served();
#else
static bool page_is_served() {
  return true;
}
#endif

int main() {
  const repel::Wrench F{{1.0, 2.0, 3.0}, repel::Vec3::Zero()};
  const repel::Twist V{{4.0, 5.0, 6.0}, repel::Vec3::Zero()};
  std::printf("%g W\n", power_elsewhere(F, V));
  return repel::power(F, V) == 32.0 && power_elsewhere(F, V) == 32.0 && page_is_served() ? 0 : 1;
}
