// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Which faults a run is to have, and from when on.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace repel::faults {

struct Fault;

inline constexpr double latest_begin = 1e6;  ///< [s] of a fault

/// A fault to inject, and when it begins.
struct Choice {
  std::string name;    ///< of one of `all_faults`
  double begin = 0.0;  ///< [s] of scene time, 0 to latest_begin; it acts from the nearest tick on
};

/// A run of a scene can have it; whether its arm has the joints for it is another matter.
[[nodiscard]] bool can_be_had(const Fault& fault);

/// The fault of that name.
/// @throws SetupError for a name that none has, with those most alike; for a fault that no run can
/// have, with those of its kind
[[nodiscard]] const Fault& fault_named(const std::string& name);

/// What `--fault` takes, NAME@SECONDS.
/// @throws SetupError for another form or time, and as `fault_named`
[[nodiscard]] Choice choice_in(const std::string& text);

/// As `choices_in` reads them; empty for none.
[[nodiscard]] std::string to_text(std::span<const Choice> choices);
/// @throws SetupError as `choice_in`
[[nodiscard]] std::vector<Choice> choices_in(const std::string& text);

/// @throws SetupError for a fault of the operator, who is in another program
void require_no_operator(std::span<const Choice> choices);

}  // namespace repel::faults
