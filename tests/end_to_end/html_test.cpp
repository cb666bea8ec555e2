// SPDX-License-Identifier: BSD-3-Clause
// The HTML page of a run: well-formed, self-contained, and with the data of the run.
#include <regex>

#include <chart.hpp>
#include <page.hpp>

#include "end_to_end/teleop.hpp"

namespace repel::test {
namespace html_test {

/// Number of occurrences of `part` in `text`.
int count_of(const std::string& text, const std::string& part) {
  int count = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

/// Checks that all elements are closed in the right order; empty if so.
std::string unbalanced(const std::string& html) {
  const std::regex tag("<(/?)([a-z0-9]+)([^>]*)>");
  std::vector<std::string> open;
  for (std::sregex_iterator it(html.begin(), html.end(), tag), end; it != end; ++it) {
    const std::string name = (*it)[2];
    const std::string rest = (*it)[3];
    if (!rest.empty() && rest.back() == '/') continue;
    if ((*it)[1].length() == 0) {
      open.push_back(name);
    } else if (open.empty() || open.back() != name) {
      return name;
    } else {
      open.pop_back();
    }
  }
  return open.empty() ? "" : open.back();
}

TEST(Html, PageOfARunHasItsCurvesAndNeedsNothingBesideItself) {
  const Folder folder;
  const Ending ending =
      teleop("two_arms --fast --seconds 5 --html " + quoted(folder / "page.html"));
  ASSERT_EQ(ending.status, 0) << ending;
  const std::string page = text_of(folder / "page.html");
  EXPECT_EQ(unbalanced(page.substr(page.find("<html"))), "");
  for (const char* outside : {"http://", "https://", "src=", "href=", "<script", "@import"}) {
    EXPECT_EQ(count_of(page, outside), 0) << outside;
  }
  EXPECT_EQ(count_of(page, "<figure>"), 8) << "two of the world, two of each arm, two of time";
  for (const char* words : {"<h1>two_arms</h1>", "Least signed distance", "right: ", "arm_obstacle",
                            "workpiece", "The scene file", "partners:", "p99", "deadline"}) {
    EXPECT_GT(count_of(page, words), 0) << words;
  }
  EXPECT_LT(page.size(), 1000000U);
  EXPECT_EQ(count_of(page, "nan"), 0);
  EXPECT_EQ(count_of(page, ">inf<"), 0);
}

TEST(Html, ByTheClockLatenessIsAmongTheCurves) {
  const Folder folder;
  const Ending ending = teleop("plates --seconds 0.5 --html " + quoted(folder / "page.html"));
  ASSERT_EQ(ending.status, 0) << ending;
  EXPECT_GT(count_of(text_of(folder / "page.html"), "wake-up lateness"), 1);
}

TEST(Html, WhatMeansSomethingThereIsEscaped) {
  EXPECT_EQ(host::page::escaped("a < b & \"c\" > 'd'"),
            "a &lt; b &amp; &quot;c&quot; &gt; &#39;d&#39;");
}

TEST(Html, CurveWithoutAValueIsAnEmptyChart) {
  const host::Chart chart{.title = "none",
                          .unit = "N",
                          .samples = 3,
                          .duration = 1.0,
                          .curves = {{"gap", [](std::size_t) { return std::nan(""); }}}};
  const std::string html = to_html(chart);
  EXPECT_EQ(unbalanced(html), "");
  EXPECT_EQ(count_of(html, "nan"), 0) << html;
  EXPECT_EQ(unbalanced(to_html(host::Chart{.title = "no sample"})), "");
}

TEST(Html, NoPeakIsLostHoweverLongTheCurveIs) {
  const host::Chart chart{
      .title = "peak",
      .unit = "N",
      .samples = 100000,
      .duration = 250.0,
      .curves = {{"one", [](std::size_t i) { return i == 54321 ? 100.0 : 0.0; }}}};
  // The top of the curve: 5 % below the top of the chart.
  const std::string html = to_html(chart);
  const std::regex peak("[ML]([0-9.]+) ([0-9.]+)");
  double highest = 1e9;
  for (std::sregex_iterator it(html.begin(), html.end(), peak), end; it != end; ++it) {
    highest = std::min(highest, std::stod((*it)[2]));
  }
  EXPECT_LT(highest, 20.0);
}

}  // namespace html_test
}  // namespace repel::test
