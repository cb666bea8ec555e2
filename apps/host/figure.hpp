/// @file
/// Numbers in reports for people.
#pragma once

#include <string>

namespace repel::host {

/// `value` with so many decimals; with an exponent from a thousand million on, and "not finite"
/// where it is no number to be printed. A zero has no sign.
[[nodiscard]] std::string figure(double value, int decimals);

}  // namespace repel::host
