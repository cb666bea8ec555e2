// SPDX-License-Identifier: BSD-3-Clause
// The HTML page of a run: well-formed, self-contained, and with the data of the run.
#include <algorithm>
#include <regex>
#include <utility>
#include <vector>

#include <repel/host/page/chart.hpp>
#include <repel/host/page/page.hpp>

#include "end_to_end/teleop.hpp"

namespace repel::test {
namespace html_test {

/// Number of occurrences of `part` in `text`.
int count_of(const std::string& text, const std::string& part) {
  int count = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

/// Without the scripts, whose comparisons look like tags, and without comments.
std::string without_scripts(std::string html) {
  for (const auto& [begin, end] : std::vector<std::pair<std::string, std::string>>{
           {"<script", "</script>"}, {"<!--", "-->"}}) {
    for (auto at = html.find(begin); at != std::string::npos; at = html.find(begin, at)) {
      html.erase(at, html.find(end, at) + end.size() - at);
    }
  }
  return html;
}

/// The data of each chart.
std::vector<nlohmann::json> charts_of(const std::string& html) {
  const std::string begin = "<script type='application/json'>";
  std::vector<nlohmann::json> charts;
  for (auto at = html.find(begin); at != std::string::npos; at = html.find(begin, at + 1)) {
    const auto from = at + begin.size();
    charts.push_back(nlohmann::json::parse(html.substr(from, html.find("</script>", at) - from)));
  }
  return charts;
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
  EXPECT_EQ(unbalanced(without_scripts(page.substr(page.find("<html")))), "");
  for (const char* outside :
       {"http://", "https://", "src=", "href=", "@import", "fetch(", "import("}) {
    EXPECT_EQ(count_of(page, outside), 0) << outside;
  }
  EXPECT_EQ(count_of(page, "<figure data-chart=''>"), 8)
      << "two of the world, two of each arm, two of time";
  EXPECT_EQ(count_of(page, "<script>"), 1);
  EXPECT_EQ(count_of(page, "globalThis.uPlot"), 1) << "which draws them";
  EXPECT_EQ(count_of(page, "Permission is hereby granted"), 1) << "and its licence";
  const std::vector<nlohmann::json> charts = charts_of(page);
  ASSERT_EQ(charts.size(), 8U);
  for (const nlohmann::json& chart : charts) {
    const bool is_of_time = chart.at("kind") == "time";
    EXPECT_EQ(chart.at("names").size(), chart.at("values").size());
    for (const nlohmann::json& curve : chart.at("values")) {
      EXPECT_EQ(curve.size(), is_of_time ? 2000U : chart.at("shares").size());
    }
  }
  for (const char* words : {"<h1>two_arms</h1>", "Least signed distance", "right: ", "arm_obstacle",
                            "workpiece", "The scene file", "partners:", "p99", "deadline"}) {
    EXPECT_GT(count_of(page, words), 0) << words;
  }
  EXPECT_LT(page.size(), 1000000U);
  EXPECT_EQ(count_of(page, "nan,"), 0);
  EXPECT_EQ(count_of(page, ",nan"), 0);
  EXPECT_EQ(count_of(page, ">inf<"), 0);
}

TEST(Html, ByTheClockLatenessIsAmongTheCurves) {
  const Folder folder;
  const Ending ending = teleop("plates --seconds 0.5 --html " + quoted(folder / "page.html"));
  ASSERT_EQ(ending.status, 0) << ending;
  EXPECT_GT(count_of(text_of(folder / "page.html"), "\"lateness\""), 1);
}

TEST(Html, EveryWordOfAHeadingSaysWhatItMeans) {
  const Folder folder;
  ASSERT_EQ(teleop("two_arms --seconds 1 --html " + quoted(folder / "page.html")).status, 0);
  const std::string page = without_scripts(text_of(folder / "page.html"));
  int words = 0;
  for (const char* heading : {"<th", "<dt"}) {
    for (auto at = page.find(heading); at != std::string::npos; at = page.find(heading, at + 1)) {
      const std::string tag = page.substr(at, page.find("</", at) - at);
      if (at > page.find("class='words'")) break;  // there the meaning stands beside it
      EXPECT_NE(tag.find(" title='"), std::string::npos) << tag;
      ++words;
    }
  }
  EXPECT_GT(words, 30);
  EXPECT_GT(count_of(page, "<dt>deadline misses</dt><dd>"), 0);
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
  EXPECT_EQ(unbalanced(without_scripts(html)), "");
  EXPECT_EQ(count_of(html, "nan"), 0) << html;
  EXPECT_EQ(charts_of(html).at(0).at("values").at(0), (nlohmann::json{nullptr, nullptr, nullptr}));
  EXPECT_EQ(unbalanced(without_scripts(to_html(host::Chart{.title = "no sample"}))), "");
}

TEST(Html, NoPeakIsLostHoweverLongTheCurveIs) {
  const host::Chart chart{
      .title = "peak",
      .unit = "N",
      .samples = 100000,
      .duration = 250.0,
      .curves = {{"one", [](std::size_t i) { return i == 54321 ? 100.0 : 0.0; }}}};
  const std::string html = to_html(chart);
  const nlohmann::json data = charts_of(html).at(0);
  const auto values = data.at("values").at(0).get<std::vector<double>>();
  EXPECT_EQ(values.size(), 4000U);
  const auto peak = std::max_element(values.begin(), values.end());
  EXPECT_EQ(*peak, 100.0);
  EXPECT_EQ(std::count(values.begin(), values.end(), 100.0), 1);
  const double at = data.at("from").get<double>() +
                    data.at("step").get<double>() * static_cast<double>(peak - values.begin());
  EXPECT_NEAR(at, 250.0 * 54321 / 100000, 250.0 / 2000) << "within its interval";
  // Without scripts: the top of the curve is 5 % below the top of the chart.
  const std::regex step("[ML]([0-9.]+) ([0-9.]+)");
  double highest = 1e9;
  for (std::sregex_iterator it(html.begin(), html.end(), step), end; it != end; ++it) {
    highest = std::min(highest, std::stod((*it)[2]));
  }
  EXPECT_LT(highest, 20.0);
}

TEST(Html, AnIntervalHasItsMinimumAndMaximumInTheirOrder) {
  // Rising in every interval of ten samples, with one that falls.
  const auto value = [](std::size_t i) {
    return i / 10 == 7 ? 100.0 - static_cast<double>(i) : static_cast<double>(i);
  };
  const host::Chart chart{.title = "order",
                          .unit = "N",
                          .samples = 20000,
                          .duration = 50.0,
                          .curves = {{"one", value}}};
  const auto values = charts_of(to_html(chart)).at(0).at("values").at(0).get<std::vector<double>>();
  ASSERT_EQ(values.size(), 4000U);
  EXPECT_EQ(values[12], 60.0);
  EXPECT_EQ(values[13], 69.0);
  EXPECT_EQ(values[14], 30.0);
  EXPECT_EQ(values[15], 21.0);
}

TEST(Html, ANameCannotEndTheDataOfAChart) {
  const host::Chart chart{.title = "names",
                          .samples = 1,
                          .curves = {{"</script>\"\xff", [](std::size_t) { return 1.0; }}}};
  const std::string html = to_html(chart);
  EXPECT_EQ(charts_of(html).at(0).at("names").at(0), "</script>\"\xef\xbf\xbd");
  EXPECT_EQ(unbalanced(without_scripts(html)), "");
}

}  // namespace html_test
}  // namespace repel::test
