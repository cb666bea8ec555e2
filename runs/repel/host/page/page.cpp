// SPDX-License-Identifier: BSD-3-Clause
#include <repel/host/page/page.hpp>

#include <cmath>
#include <string_view>

#include <repel/base/setup_error.hpp>

#include "page_script.hpp"
#include "page_style.hpp"

namespace repel::host::page {

std::string escaped(const std::string& text) {
  std::string html;
  for (const char c : text) {
    switch (c) {
      case '&':
        html += "&amp;";
        break;
      case '<':
        html += "&lt;";
        break;
      case '>':
        html += "&gt;";
        break;
      case '\'':
        html += "&#39;";
        break;
      case '"':
        html += "&quot;";
        break;
      default:
        html += c;
    }
  }
  return html;
}

std::string number(double value) {
  return std::isfinite(value) ? repel::to_text(value, 4) : "-";
}

std::string with_unit(double value, const char* unit) {
  return std::isfinite(value) ? number(value) + " " + unit : "-";
}

namespace {

/// As an attribute with a space before it; nothing if there is no text.
std::string title_of(std::string_view text) {
  if (text.empty()) return {};
  std::string attribute = " title='";
  return attribute.append(escaped(std::string(text))).append("'");
}

}  // namespace

std::string table(const std::vector<std::vector<std::string>>& rows, std::size_t names,
                  std::string_view (*meaning_of)(std::string_view)) {
  std::string html = "<table>";
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const char* cell = row == 0 ? "th" : "td";
    html += "<tr>";
    for (std::size_t i = 0; i < rows[row].size(); ++i) {
      const bool is_explained = row == 0 && meaning_of != nullptr;
      html += std::string("<") + cell + (i < names ? " class='name'" : "") +
              (is_explained ? title_of(meaning_of(rows[row][i])) : std::string()) + ">" +
              escaped(rows[row][i]) + "</" + cell + ">";
    }
    html += "</tr>\n";
  }
  return html + "</table>\n";
}

std::string tile(const std::string& name, const std::string& value, std::string_view meaning) {
  return "<div><dt" + title_of(meaning) + ">" + escaped(name) + "</dt><dd>" + escaped(value) +
         "</dd></div>\n";
}

std::string where(const Machine& machine) {
  std::string html = "<p>";
  html += escaped(machine.cpu) + ", " + escaped(machine.kernel);
  html += "<br/>granted: " + escaped(machine.scheduler);
  html += "<br/>" + escaped(machine.compiler) + ", pairs by " + escaped(machine.instruction_set) +
          ", commit " + escaped(machine.commit) + "</p>\n";
  return html;
}

void begin(const std::string& title, std::ostream& out) {
  const std::string name = escaped(title);
  out << "<!doctype html>\n<html lang='en'>\n<head>\n<meta charset='utf-8'/>\n"
      << "<meta name='viewport' content='width=device-width, initial-scale=1'/>\n<title>" << name
      << " - repel</title>\n<style>" << style << "</style>\n</head>\n<body>\n<h1>" << name
      << "</h1>\n";
}

void end(std::ostream& out) {
  out << "<!-- Of uPlot, the first of the scripts:\n";
  for (const std::string_view piece : script_licence) out << piece;
  out << "-->\n<script>\n";
  for (const std::string_view piece : script) out << piece;
  out << "</script>\n</body>\n</html>\n";
}

}  // namespace repel::host::page
