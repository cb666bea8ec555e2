// SPDX-License-Identifier: BSD-3-Clause
#include <repel/host/figure.hpp>

#include <cmath>
#include <cstdio>

namespace repel::host {

std::string figure(double value, int decimals) {
  if (!std::isfinite(value)) return "not finite";
  char text[40];
  const bool is_huge = std::abs(value) >= 1e9;
  (void)std::snprintf(text, sizeof text, is_huge ? "%.*e" : "%.*f", decimals, value);
  const std::string figures = text;
  const bool is_zero = !is_huge && figures.find_first_of("123456789") == std::string::npos;
  return is_zero && figures[0] == '-' ? figures.substr(1) : figures;
}

}  // namespace repel::host
