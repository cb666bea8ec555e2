// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Formats numbers for text reports.
#pragma once

#include <string>

namespace repel::host {

/// `value` with this number of decimals; with an exponent from 1e9 on, "not finite" for infinity
/// and NaN. A zero has no sign.
[[nodiscard]] std::string figure(double value, int decimals);

}  // namespace repel::host
