// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Tables in Markdown.
#pragma once

#include <cstdarg>
#include <cstdio>
#include <string>
#include <vector>

namespace repel::bench {

/// Formats like printf.
[[gnu::format(printf, 1, 2)]] inline std::string text(const char* format, ...) {
  char buffer[1024];
  va_list values;
  va_start(values, format);
  std::vsnprintf(buffer, sizeof buffer, format, values);
  va_end(values);
  return buffer;
}

/// The first column is text; so are the others if `numbers` is false.
inline std::string heading(const std::vector<std::string>& columns, bool numbers = true) {
  std::string line = "|";
  std::string rule = "|";
  for (std::size_t i = 0; i < columns.size(); ++i) {
    line += text(" %s |", columns[i].c_str());
    rule += i > 0 && numbers ? "---:|" : "---|";
  }
  return line + "\n" + rule + "\n";
}

}  // namespace repel::bench
