// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The parts of the benchmark.
#pragma once

#include "../parts.hpp"

namespace repel::engines {

using bench::Json;
using bench::Options;
using bench::progress;
using bench::Result;

[[nodiscard]] Result sweep(const Options& options);
[[nodiscard]] Result energy(const Options& options);
[[nodiscard]] Result swing_period(const Options& options);
[[nodiscard]] Result gravity(const Options& options);

}  // namespace repel::engines
