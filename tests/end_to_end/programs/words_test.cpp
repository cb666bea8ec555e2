// SPDX-License-Identifier: BSD-3-Clause
// The text of reports, also of unusual runs: every number is finite and of readable length, nothing
// is reported that was not measured, and names are unchanged.
#include <repel/host/figure.hpp>
#include <repel/host/page/page.hpp>

#include <limits>
#include <regex>
#include <utility>

#include "end_to_end/teleop.hpp"

namespace repel::test {
namespace words_test {

/// A run with all its reports.
struct Reported {
  explicit Reported(const std::string& arguments)
      : ending(teleop(arguments + " --report " + quoted(folder / "report.json") + " --html " +
                      quoted(folder / "page.html") + " --log " + quoted(folder / "log.csv"))),
        page(text_of(folder / "page.html")) {
    if (ending.status == 0) report = report_of(folder / "report.json");
  }

  Folder folder;
  Ending ending;
  std::string page;
  nlohmann::json report;
};

/// Expects readable words and numbers, in the table and on the page.
void expect_readable(const Reported& run) {
  ASSERT_EQ(run.ending.status, 0) << run.ending;
  const std::string body = run.page.substr(0, run.page.find("The scene file"));
  for (const std::string& text : {run.ending.out, body}) {
    for (const char* word : {"-?\\bnan\\b", "-?\\binf\\b", "[0-9]{13}", " -0(\\.0*)? "}) {
      std::smatch found;
      EXPECT_FALSE(std::regex_search(text, found, std::regex(word)))
          << "..." << found.prefix().str().substr(std::max<long>(0, found.position() - 80L))
          << found.str();
    }
  }
  EXPECT_FALSE(run.report.empty());
}

std::string bare(const std::string& rest) {
  return robot_text() + "obstacles: []\n" + rest;
}

TEST(Words, OddRunsAreReportedInWordsAndNumbersThatCanBeRead) {
  const Folder folder;
  const std::string no_script = folder.with("no_script.yaml", robot_text() + table_text());
  const std::string empty_script =
      folder.with("empty_script.yaml", robot_text() + table_text() + "script: []\n");
  const std::string alone = folder.with("alone.yaml", bare(push_text()));
  const std::string runs[] = {"anderson_4x8 --seconds 0 --fast",
                              "anderson_4x8 --seconds 0",
                              "empty --seconds 0.0025",
                              "anderson_4x8 --seconds 0.0025 --fast",
                              "anderson_4x8 --seconds 1e-9 --fast",
                              "empty --rate 1 --seconds 2",
                              "empty --rate 1 --seconds 100 --fast --backend ideal",
                              "empty --rate 100000 --seconds 0.05",
                              "plates --rate 100000 --seconds 0.05 --fast",
                              quoted(no_script) + " --fast --seconds 0.5",
                              quoted(empty_script) + " --fast --seconds 0.5",
                              quoted(alone) + " --fast --seconds 0.5",
                              quoted(alone) + " --fast --seconds 0.5 --tool-alone --threads 2"};
  for (const std::string& arguments : runs) {
    SCOPED_TRACE(arguments);
    expect_readable(Reported(arguments));
  }
}

TEST(Words, WithNothingNearTheNearestIsNone) {
  const Folder folder;
  const Reported run(quoted(folder.with("scene.yaml", bare(""))) + " --fast --seconds 0.1");
  expect_readable(run);
  EXPECT_TRUE(std::regex_search(run.ending.out, std::regex("\n  nearest +none\n"))) << run.ending;
  EXPECT_NE(run.page.find(">nearest of all pairs</dt><dd>none</dd>"), std::string::npos);
  EXPECT_TRUE(run.report.at("nearest_m").is_null());
  EXPECT_EQ(run.report.at("nearest_pair"), "");
}

TEST(Words, RunThatIsNotByTheClockClaimsNoDeadline) {
  const Reported fast("plates --fast --seconds 0.1");
  expect_readable(fast);
  EXPECT_TRUE(
      std::regex_search(fast.ending.out, std::regex("\n  deadline misses +not by the clock\n")))
      << fast.ending;
  EXPECT_FALSE(fast.ending.says("misses 0")) << "nor in the progress line\n" << fast.ending;
  EXPECT_EQ(fast.report.at("by_the_clock"), false);
  for (const char* key :
       {"deadline_misses", "success_rate_last_100", "success_rate_lowest", "response_us_max"}) {
    EXPECT_TRUE(fast.report.at(key).is_null()) << key;
  }
  EXPECT_TRUE(std::regex_search(
      fast.ending.out, std::regex("\n400 Hz: not by the clock; the slowest tick computed for "
                                  "[0-9]+\\.[0-9] % of a period\n$")))
      << fast.ending;
  EXPECT_FALSE(fast.ending.says("met in")) << fast.ending;
  for (const auto& share : fast.report.at("wakeup_us")) EXPECT_TRUE(share.is_null());
  const Reported timed("plates --seconds 0.1");
  EXPECT_TRUE(timed.report.at("deadline_misses").is_number());
  EXPECT_EQ(timed.report.at("by_the_clock"), true);
}

TEST(Words, TheVerdictIsTheLastLineAndAgreesWithTheReport) {
  const Reported run("plates --seconds 0.5");
  std::smatch verdict;
  ASSERT_TRUE(std::regex_search(
      run.ending.out, verdict,
      std::regex("\n400 Hz: met in ([0-9]+) of ([0-9]+) ticks, worst ([0-9]+\\.[0-9]) % of the "
                 "period\n$")))
      << run.ending;
  const int due = run.report.at("ticks").get<int>() + run.report.at("skipped_ticks").get<int>();
  EXPECT_GE(due, 200);
  EXPECT_EQ(std::stoi(verdict[2]), due);
  EXPECT_EQ(std::stoi(verdict[1]), due - run.report.at("deadline_misses").get<int>());
  const double worst = run.report.at("response_us_max").get<double>() / 2500.0;
  EXPECT_NEAR(std::stod(verdict[3]), 1e2 * worst, 0.051);
  EXPECT_GE(run.report.at("response_us_max"), run.report.at("compute_us").at("max"));
}

TEST(Words, WarningsStandBeforeTheNumbers) {
  const Folder folder;
  const std::string scene =
      folder.with("scene.yaml", "start_inside: push_out\n" + robot_text() +
                                    "obstacles:\n  - {name: around, shape: sphere, radius: 100 mm, "
                                    "position: 0.6 -0.15 0.5 m}\n"
                                    "laws:\n  default: {range: 1 mm, surface_force: 1 N, "
                                    "damping: 1 N s/m}\n");
  const Reported run(quoted(scene) + " --fast --seconds 0.1");
  ASSERT_EQ(run.ending.status, 0) << run.ending;
  ASSERT_FALSE(run.report.at("warnings").empty()) << "the scene is to give one\n" << run.ending;
  const std::string warning = run.report.at("warnings").at(0);
  EXPECT_LT(run.ending.out.find(warning), run.ending.out.find("compute of the tick"));
  EXPECT_LT(run.page.find(host::page::escaped(warning)), run.page.find("class='tiles'"));
}

TEST(Words, HugeNumbersGetAnExponent) {
  EXPECT_EQ(host::figure(1234.5678, 2), "1234.57");
  EXPECT_EQ(host::figure(-0.5, 3), "-0.500");
  EXPECT_EQ(host::figure(-0.00001, 4), "0.0000");
  EXPECT_EQ(host::figure(1e300, 2), "1.00e+300");
  EXPECT_EQ(host::figure(-1.5e9, 1), "-1.5e+09");
  EXPECT_EQ(host::figure(std::numeric_limits<double>::infinity(), 2), "not finite");
  EXPECT_EQ(host::figure(-std::nan(""), 2), "not finite");
  const Folder folder;
  std::string text = robot_text() + "obstacles: []\n";
  text.replace(text.find("0 45 -180"), 1, "1e140");
  const Ending start = teleop(quoted(folder.with("start.yaml", text)) + " --fast");
  EXPECT_EQ(start.status, 1) << start;
  EXPECT_FALSE(std::regex_search(start.err, std::regex("[0-9]{20}"))) << start;
  const std::string long_seconds = "--seconds " + std::string(140, '9');
  const std::string long_rate = "--rate " + std::string(140, '9');
  for (const std::string& arguments : {long_seconds, long_rate}) {
    const Ending ending = teleop(arguments);
    EXPECT_EQ(ending.status, 2) << ending;
    EXPECT_FALSE(std::regex_search(ending.err, std::regex("[0-9]{20}"))) << ending;
  }
}

/// The cells of the CSV text, row by row, parsed according to RFC 4180.
std::vector<std::vector<std::string>> cells_of(const std::string& text) {
  std::vector<std::vector<std::string>> rows(1);
  std::string cell;
  bool in_quotes = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_quotes) {
      in_quotes = c != '"' || (i + 1 < text.size() && text[i + 1] == '"');
      if (c == '"' && in_quotes) ++i;
      if (in_quotes) cell += c;
    } else if (c == '"') {
      in_quotes = true;
    } else if (c == ',' || c == '\n') {
      rows.back().push_back(std::exchange(cell, {}));
      if (c == '\n') rows.emplace_back();
    } else {
      cell += c;
    }
  }
  rows.pop_back();
  return rows;
}

TEST(Words, NamesWithQuotesCommasAndNewlinesBreakNoFile) {
  const std::string name = "a \"b\", <c>\n& 'd'";
  const std::string in_yaml = "\"a \\\"b\\\", <c>\\n& 'd'\"";
  std::string text = robot_text() + table_text() + push_text() + "name: " + in_yaml + "\n";
  text.replace(text.find("name: table"), 11, "name: " + in_yaml);
  text.replace(text.find("name: rod"), 9, "name: " + in_yaml);
  text +=
      "network:\n  - {module: torque_arm}\n  - {module: multiplex}\n  - {module: spaceball, "
      "name: " +
      in_yaml + "}\n  - {module: kbb2}\n  - {module: obstacle}\n  - {module: puma_kin}\n" +
      "  - {module: puma_joints}\n";
  const Folder folder;
  const Reported run(quoted(folder.with("scene.yaml", text)) + " --fast --seconds 1.5");
  ASSERT_EQ(run.ending.status, 0) << run.ending;
  EXPECT_EQ(run.report.at("scene"), name);
  EXPECT_EQ(run.report.at("obstacles").at(0).at("name"), name);
  const auto rows = cells_of(text_of(run.folder / "log.csv"));
  ASSERT_EQ(rows.size(), 601U);
  std::size_t hardest = 0;
  for (const auto& row : rows) {
    ASSERT_EQ(row.size(), rows[0].size());
    hardest += row[3] == name + " - " + name ? 1 : 0;
  }
  EXPECT_GT(hardest, 20U) << "the table was felt";
  EXPECT_EQ(std::count(rows[0].begin(), rows[0].end(), "energy_" + name + "_j"), 1);
  EXPECT_EQ(run.page.find("<c>"), std::string::npos) << "only in &lt; and &gt;";
  EXPECT_NE(run.page.find(host::page::escaped(name)), std::string::npos);
}

}  // namespace words_test
}  // namespace repel::test
