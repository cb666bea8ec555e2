// SPDX-License-Identifier: BSD-3-Clause
#include "end_to_end/trial_report.hpp"

namespace repel::test {
namespace deadline_test {

Ending deadline(const std::string& arguments) {
  return run_program(REPEL_DEADLINE, arguments);
}

TEST(Deadline, OneRateIsOneObject) {
  const Folder folder;
  const Ending ending = deadline("--rate 1000 --seconds 1 --json " + quoted(folder / "d.json"));
  ASSERT_EQ(ending.status, 0) << ending;
  expect_trial(report_of(folder / "d.json"), 1000.0, 1000);
  EXPECT_TRUE(ending.says("lateness")) << "the table\n" << ending;
}

TEST(Deadline, SeveralRatesAreAListInTheirOrder) {
  const Folder folder;
  const Ending ending =
      deadline("--rate 1000 400 --seconds 0.5 --json " + quoted(folder / "d.json"));
  ASSERT_EQ(ending.status, 0) << ending;
  const auto reports = report_of(folder / "d.json");
  ASSERT_EQ(reports.size(), 2U);
  expect_trial(reports[0], 1000.0, 500);
  expect_trial(reports[1], 400.0, 200);
}

TEST(Deadline, InterruptionEndsItWithWhatIsMeasured) {
  const Folder folder;
  const Ending ending =
      run_program("timeout", "--preserve-status -s INT 3 " + quoted(REPEL_DEADLINE) +
                                 " --rate 400 1000 --json " + quoted(folder / "d.json"));
  EXPECT_EQ(ending.status, 0) << ending;
  const auto reports = report_of(folder / "d.json");
  ASSERT_EQ(reports.size(), 1U) << "a list, as was asked for, of the one rate there was time for";
  EXPECT_TRUE(reports[0].at("interrupted"));
  EXPECT_GT(reports[0].at("ticks"), 0);
  EXPECT_TRUE(ending.says("interrupted")) << ending;
}

TEST(Deadline, HelpNamesOptionsRatesAndExitStatus) {
  const Ending ending = deadline("--help");
  EXPECT_EQ(ending.status, 0) << ending;
  for (const char* words : {"--rate", "--seconds", "--json", "10000", "60", "Exit status"}) {
    EXPECT_TRUE(ending.says(words)) << words << '\n' << ending;
  }
}

TEST(Deadline, BadUsageEndsWithTwoAndSaysWhy) {
  for (const char* arguments : {"--no-such-option", "--rate 0", "--rate 400 fast", "--rate nan",
                                "--seconds -1", "--seconds 0", "word", "--json"}) {
    const Ending ending = deadline(arguments);
    EXPECT_EQ(ending.status, 2) << arguments << '\n' << ending;
    EXPECT_FALSE(ending.err.empty()) << arguments;
  }
}

// It ends at once: the run that was requested takes four minutes.
TEST(Deadline, FileThatCannotBeWrittenEndsWithOneAndNamesThePath) {
  const Ending ending = deadline("--json /no/such/folder/file");
  EXPECT_EQ(ending.status, 1) << ending;
  EXPECT_TRUE(ending.says("/no/such/folder/file")) << ending;
}

}  // namespace deadline_test
}  // namespace repel::test
