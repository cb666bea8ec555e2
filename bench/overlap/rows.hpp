// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The results as Markdown.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "conduct.hpp"

namespace repel::bench {

/// One line of the table: a setting on an input.
struct Row {
  const Library& library;
  std::unique_ptr<Measurement> cold, warm;
  Conduct conduct;

  /// Answers that are wrong or missing, cold and warm.
  [[nodiscard]] int wrong() const { return cold->verdict().wrong() + warm->verdict().wrong(); }
  [[nodiscard]] int asked() const { return cold->verdict().asked + warm->verdict().asked; }
};
using Rows = std::vector<Row>;

/// For each input: times, errors, wrong answers, dead zones and jumps.
[[nodiscard]] std::string overlap_table(const Rows& rows);

/// The faults of repel, a line each: wrong answers, and values that jump.
[[nodiscard]] std::string faults(const Rows& rows);

}  // namespace repel::bench
