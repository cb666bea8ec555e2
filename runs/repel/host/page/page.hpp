// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Builds self-contained HTML pages (reports).
#pragma once

#include <cstddef>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

#include <repel/host/machine.hpp>

namespace repel::host::page {

/// `text` with the special characters of HTML escaped.
[[nodiscard]] std::string escaped(const std::string& text);

/// A number with four significant digits; "-" if not finite.
[[nodiscard]] std::string number(double value);

/// The same with its unit; "-" if not finite.
[[nodiscard]] std::string with_unit(double value, const char* unit);

/// An HTML table; cells are escaped, the first row is the header, the first `names` columns are
/// text.
/// @param meaning_of what a word of the header means, shown at the pointer; null or empty: nothing
[[nodiscard]] std::string table(const std::vector<std::vector<std::string>>& rows,
                                std::size_t names,
                                std::string_view (*meaning_of)(std::string_view) = nullptr);

/// A name and its value, as an entry of <dl class='tiles'>, with what the name means.
[[nodiscard]] std::string tile(const std::string& name, const std::string& value,
                               std::string_view meaning = {});

/// The machine, as a paragraph.
[[nodiscard]] std::string where(const Machine& machine);

/// begin() writes everything before the content, with the title as the first heading; end()
/// everything after it, with the scripts that draw charts.
void begin(const std::string& title, std::ostream& out);
void end(std::ostream& out);

}  // namespace repel::host::page
