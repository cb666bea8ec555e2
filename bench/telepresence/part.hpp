// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The parts of the benchmark.
#pragma once

#include <span>

#include "../parts.hpp"

namespace repel::telepresence {

using bench::Json;
using bench::Options;
using bench::Part;
using bench::progress;
using bench::Result;

/// All of them, in the order in which they run.
[[nodiscard]] std::span<const Part> parts();

[[nodiscard]] Result delay(const Options& options);
[[nodiscard]] Result transparency(const Options& options);
[[nodiscard]] Result zwidth(const Options& options);
[[nodiscard]] Result hold(const Options& options);
// These need the simulated arm.
[[nodiscard]] Result contact(const Options& options);
[[nodiscard]] Result align(const Options& options);
[[nodiscard]] Result relief(const Options& options);
[[nodiscard]] Result joint_limits(const Options& options);
[[nodiscard]] Result friction(const Options& options);
[[nodiscard]] Result reflection(const Options& options);

}  // namespace repel::telepresence
