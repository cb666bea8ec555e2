// SPDX-License-Identifier: BSD-3-Clause
#include <repel/repel.hpp>

double power_elsewhere(const repel::Wrench& F, const repel::Twist& V);

double power_elsewhere(const repel::Wrench& F, const repel::Twist& V) {
  return repel::power(F, V);
}
