// SPDX-License-Identifier: BSD-3-Clause
// The hand of an operator as a table.
#include <cmath>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <end_to_end/folder.hpp>
#include <repel/base/setup_error.hpp>
#include <repel/runs/operator/operator_input.hpp>
#include <repel/runs/options/hand_track.hpp>

namespace repel::runs {
namespace hand_track_test {

const std::string first_line = "time_s,vx_m_s,vy_m_s,vz_m_s,wx_rad_s,wy_rad_s,wz_rad_s";

HandRow row(double time, double x) {
  return {time, {{x, 0, 0}, {0, 0, 2 * x}}};
}

network::Command at(const HandTrack& track, double time) {
  network::Command command;
  track.read(time, command);
  return command;
}

TEST(HandTrack, IsLinearBetweenRowsAndAtRestOutside) {
  const HandTrack track({row(0.1, 0.0), row(0.2, 0.4), row(0.4, 0.4)});
  EXPECT_EQ(at(track, 0.05).hand.ball.linear.x(), 0.0);
  EXPECT_DOUBLE_EQ(at(track, 0.15).hand.ball.linear.x(), 0.2);
  EXPECT_DOUBLE_EQ(at(track, 0.15).hand.ball.angular.z(), 0.4);
  EXPECT_EQ(at(track, 0.3).hand.ball.linear.x(), 0.4);
  EXPECT_EQ(at(track, 0.4).hand.ball.linear.x(), 0.4);
  EXPECT_EQ(at(track, 0.41).hand.ball.linear.x(), 0.0);
  EXPECT_EQ(at(HandTrack({}), 0.0).hand.ball.linear.x(), 0.0);
}

// A sum of periods is not quite the time of a table.
TEST(HandTrack, TakesARowToTheBitWhereTheTimeIsRounded) {
  std::vector<HandRow> rows;
  for (int i = 0; i < 2000; ++i) rows.push_back(row(i * 0.0025, 0.001 * i));
  const HandTrack track(rows);
  double time = 0.0;
  for (const HandRow& each : rows) {
    EXPECT_EQ(at(track, time).hand.ball.linear.x(), each.rates.linear.x()) << time;
    time += 0.0025;
  }
}

TEST(HandTrack, DrivesInPlaceOfTheScript) {
  network::Phase phase;
  phase.rates.linear = {1, 0, 0};
  OperatorInput operators({phase});
  const HandTrack track({row(0.0, 0.1), row(1.0, 0.2)});
  operators.follow(track);
  EXPECT_EQ(operators.step(Mat3::Identity(), 0.5).hand.ball.linear.x(), 0.1);
  EXPECT_EQ(operators.step(Mat3::Identity(), 0.5).hand.ball.linear.x(), 0.15000000000000002);
  EXPECT_EQ(operators.phase(), 1);  // none of the script
}

std::string complaint(const std::string& text) {
  const test::Folder folder;
  const std::string file = folder / "hand.csv";
  std::ofstream(file) << text;
  try {
    (void)read_hand_track(file);
  } catch (const SetupError& error) {
    return error.what();
  }
  return "none";
}

TEST(HandTrack, OfAFileIsReadOrRefusedWithItsLine) {
  EXPECT_EQ(complaint(first_line + "\n0,0,0,0,0,0,0\n1,0.1,0,0,0,0,0\r\n"), "none");
  EXPECT_EQ(complaint(first_line + ",lever_rad_s,direction_x,direction_y,direction_z\n" +
                      "0,0,0,0,0,0,0,1,0,0,-1\n"),
            "none");
  const struct {
    const char* rows;
    const char* said;
  } bad[] = {{"0,0,0,0,0,0\n", "hand.csv:2: a line of a hand without 7 numbers"},
             {"0,0,0,0,0,0,x\n", "hand.csv:2: a line of a hand without 7 numbers"},
             {"0,0,0,0,0,0,nan\n", "hand.csv:2: row 1 of the hand has what is no number"},
             {"0,0,0,0,0,0,0\n0,0,0,0,0,0,0\n", "hand.csv:3: row 2 of the hand is not later"},
             {"-1,0,0,0,0,0,0\n", "hand.csv:2: row 1 of the hand is before time 0"}};
  for (const auto& [rows, said] : bad) {
    const std::string found = complaint(first_line + "\n" + rows);
    EXPECT_NE(found.find(said), std::string::npos) << found;
  }
  EXPECT_NE(complaint("t,x\n").find("allowed: " + first_line), std::string::npos);
}

}  // namespace hand_track_test
}  // namespace repel::runs
