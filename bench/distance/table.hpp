// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The results as Markdown.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "measurement.hpp"

namespace repel::bench {

using Measurements = std::vector<std::unique_ptr<Measurement>>;

/// The settings of the libraries; the median cost of each task, with wrong answers marked; the
/// speed-up of repel; all percentiles and errors.
[[nodiscard]] std::string comparison_table(const Measurements& all);

/// Run time against error, for each tolerance.
[[nodiscard]] std::string sweep_table(const Measurements& all);

}  // namespace repel::bench
