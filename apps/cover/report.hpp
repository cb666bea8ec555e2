// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The report of `cover` as JSON.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include <repel/cover/cover.hpp>

namespace repel::cover {

/// Everything of `cover`, in m, with what was asked for.
[[nodiscard]] nlohmann::ordered_json report_of(const Cover& cover, const std::string& mesh,
                                               const CoverOptions& options);

}  // namespace repel::cover
