// SPDX-License-Identifier: BSD-3-Clause
// The program that measures position servos: which logs it takes, and what it says of others.
#include <algorithm>
#include <sstream>

#include "end_to_end/program.hpp"

namespace repel::test {
namespace step_response_test {

Ending step_response(const std::string& arguments) {
  return run_program(REPEL_STEP_RESPONSE, arguments);
}

/// A ramp of 0.2 rad/s that joint 1 follows 20 ms later, and joint 2 is not asked for.
std::string log_of(const std::string& names, const char* divider) {
  std::ostringstream log;
  log << names << '\n';
  const auto ramp = [](int k) { return 0.0004 * std::clamp(k - 100, 0, 400); };
  for (int k = 0; k < 700; ++k) {
    log << 0.002 * k << divider << ramp(k) << divider << 0.5 << divider << ramp(k - 10) << divider
        << 0.5 << '\n';
  }
  return log.str();
}

const std::string names = "time,commanded_1,commanded_2,measured_1,measured_2";

TEST(StepResponse, IsToldPerJointAndAsTheKeyOfAScene) {
  const Folder folder;
  const Ending ending = step_response(quoted(folder.with("log.csv", log_of(names, ","))) +
                                      " --json " + quoted(folder / "r.json"));
  EXPECT_EQ(ending.status, 0) << ending;
  EXPECT_TRUE(ending.says("700 lines, 2.000 ms apart")) << ending;
  EXPECT_TRUE(ending.says("robot: {admittance: {response: 20 ms}}") ||
              ending.says("robot: {admittance: {response: 21 ms}}"))
      << ending;
  const auto report = report_of(folder / "r.json");
  EXPECT_NEAR(report.at("response_s"), 0.02, 1e-4);
  ASSERT_EQ(report.at("joints").size(), 1U) << "joint 2 was not commanded to move";
  EXPECT_EQ(report.at("joints").at(0).at("joint"), "1");
}

TEST(StepResponse, TakesOtherNamesDividersAndARate) {
  const Folder folder;
  const std::string log =
      folder.with("log.txt", log_of("timestamp target_q_0 target_q_1 actual_q_0 actual_q_1", " "));
  const std::string columns = " --commanded target_q --measured actual_q";
  EXPECT_EQ(step_response(quoted(log) + columns + " --time timestamp").status, 0);
  const Ending by_rate = step_response(quoted(log) + columns + " --rate 1000");
  EXPECT_EQ(by_rate.status, 0);
  EXPECT_TRUE(by_rate.says("700 lines, 1.000 ms apart")) << by_rate;
}

TEST(StepResponse, WithoutAMotionThatIsExplainedThereIsNone) {
  const Folder folder;
  std::string text = names + '\n';
  for (int k = 0; k < 100; ++k) {
    text += std::to_string(0.002 * k) + ',' + std::to_string(0.001 * k) + ",0,0.1,0\n";
  }
  const Ending ending = step_response(quoted(folder.with("log.csv", text)));
  EXPECT_EQ(ending.status, 1) << ending;
  EXPECT_TRUE(ending.says("NOT EXPLAINED")) << ending;
  EXPECT_FALSE(ending.says("In a scene")) << ending;
}

TEST(StepResponse, NamesTheLineThatIsWrong) {
  const Folder folder;
  const std::string good = log_of(names, ",");
  const auto said = [&](const std::string& text) {
    const Ending ending = step_response(quoted(folder.with("log.csv", text)));
    EXPECT_EQ(ending.status, 2) << ending;
    return ending.err;
  };
  const auto expect = [&](const std::string& text, const std::string& words) {
    const std::string err = said(text);
    EXPECT_NE(err.find(words), std::string::npos) << err;
  };
  expect("", "log.csv: the file is empty");
  expect("time,commanded_1,measured_2\n0,0,0\n", "no column 'measured_1'");
  expect("time,a,b\n0,0,0\n", "no column 'commanded'");
  expect("commanded,measured\n0,0\n", "no column 'time'");
  expect(good + "1.4,0,0,0\n", "log.csv:702: 4 columns");
  expect(good + "1.4,0,0,nan,0\n", "log.csv:702: 'nan' in column 'measured_1'");
  expect(good + "1.5,0,0,0,0\n", "log.csv:702: the time is");
  EXPECT_EQ(step_response("/no/such/log.csv").status, 2);
  EXPECT_EQ(step_response("").status, 2);
}

}  // namespace step_response_test
}  // namespace repel::test
