// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Builds self-contained HTML pages (reports).
#pragma once

#include <cstddef>
#include <ostream>
#include <string>
#include <vector>

#include "machine.hpp"

namespace repel::host::page {

/// `text` with the special characters of HTML escaped.
[[nodiscard]] std::string escaped(const std::string& text);

/// A number with four significant digits; "-" if not finite.
[[nodiscard]] std::string number(double value);

/// The same with its unit; "-" if not finite.
[[nodiscard]] std::string with_unit(double value, const char* unit);

/// An HTML table; cells are escaped, the first row is the header, the first `names` columns are
/// text.
[[nodiscard]] std::string table(const std::vector<std::vector<std::string>>& rows,
                                std::size_t names);

/// A name and its value, as an entry of <dl class='tiles'>.
[[nodiscard]] std::string tile(const std::string& name, const std::string& value);

/// The machine, as a paragraph.
[[nodiscard]] std::string where(const Machine& machine);

/// begin() writes everything before the content, with the title as the first heading; end()
/// everything after it.
void begin(const std::string& title, std::ostream& out);
void end(std::ostream& out);

}  // namespace repel::host::page
