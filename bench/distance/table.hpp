/// @file
/// The results as Markdown.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "measurement.hpp"

namespace repel::bench {

using Measurements = std::vector<std::unique_ptr<Measurement>>;

/// How the libraries were set; what each task costs (median) with wrong answers marked; how many
/// times faster ours is; all percentiles and errors.
[[nodiscard]] std::string comparison_table(const Measurements& all);

/// Time against error, tolerance by tolerance.
[[nodiscard]] std::string sweep_table(const Measurements& all);

}  // namespace repel::bench
