/// @file
/// Pages that programs write for people: each one file that needs nothing beside itself.
#pragma once

#include <ostream>
#include <string>
#include <vector>

#include <repel/schedule/deadline.hpp>

#include "chart.hpp"
#include "machine.hpp"

namespace repel::host::page {

/// `text` with the characters replaced that mean something in HTML.
[[nodiscard]] std::string escaped(const std::string& text);

/// A number of four digits; "-" for one that is not finite.
[[nodiscard]] std::string number(double value);

/// The same and its unit; "-" for one that is not finite.
[[nodiscard]] std::string with_unit(double value, const char* unit);

/// Rows of cells, which are escaped; the first row is the head, columns before `names` are text.
[[nodiscard]] std::string table(const std::vector<std::vector<std::string>>& rows,
                                std::size_t names);

/// One fact among others between <dl class='tiles'> and </dl>.
[[nodiscard]] std::string tile(const std::string& name, const std::string& value);

/// From the half to the last sample in 10^5, for a PercentileChart.
[[nodiscard]] std::vector<Percentile> percentiles(const DurationHistogram& times);

/// Where it ran, as a paragraph.
[[nodiscard]] std::string where(const Machine& machine);

/// Everything before the content, with the title as the first heading, and everything after it.
void begin(const std::string& title, std::ostream& out);
void end(std::ostream& out);

}  // namespace repel::host::page
