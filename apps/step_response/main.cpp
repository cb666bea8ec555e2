// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Measures how late a position servo is, from a log of its positions.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include <repel/cell/servo_response.hpp>
#include <repel/host/command_line.hpp>
#include <repel/host/times.hpp>

#include "log_file.hpp"

namespace {

using namespace repel;

struct Arguments {
  std::string log, json;
  LogColumns columns;
  double rate = 0.0;  // [Hz]
};

void describe(CLI::App& app, Arguments& a) {
  app.add_option("log", a.log, "Table of text: a line of names, then one of numbers per period")
      ->required()
      ->type_name("FILE");
  app.add_option("--commanded", a.columns.commanded, "Columns of what you sent [rad, m]: NAME_...")
      ->capture_default_str()
      ->type_name("NAME");
  app.add_option("--measured", a.columns.measured, "Columns of what the arm read, as many")
      ->capture_default_str()
      ->type_name("NAME");
  app.add_option("--time", a.columns.time, "Column of the time [s]")
      ->capture_default_str()
      ->type_name("NAME");
  app.add_option("--rate", a.rate, "Lines per second [Hz], in place of the column of the time")
      ->check(host::between(1.0, 1e6));
  app.add_option("--json", a.json, "Write the results as JSON to FILE")->type_name("FILE");
  app.footer(
      "For each joint it finds the dead time and the first-order lag that explain the measured\n"
      "positions best. Their sum is the response of an admittance ('robot: admittance' of a\n"
      "scene, AdmittanceOptions::response). Log a ramp of 0.1 to 0.2 rad/s for a second, up and\n"
      "down, with a second of rest before each, or any other motion that turns often.\n\n"
      "Exit status: 0 all joints that moved are explained, 1 one is not or none moved, 2 bad "
      "usage\n"
      "or file.");
}

struct Found {
  std::string name;
  ServoResponse servo;
};

/// [rad] or [m] A joint that was commanded less than this stood still.
constexpr double still = 1e-4;

bool was_commanded(const JointLog& joint) {
  const auto [least, most] = std::minmax_element(joint.commanded.begin(), joint.commanded.end());
  return least != joint.commanded.end() && *most - *least > still;
}

int run(const Arguments& arguments) {
  host::Output json(arguments.json);
  const PositionLog log = read_position_log(arguments.log, arguments.columns, arguments.rate);
  std::vector<Found> found;
  for (const JointLog& joint : log.joints) {
    if (!was_commanded(joint)) continue;
    found.push_back({joint.name, find_response(joint.commanded, joint.measured, log.period)});
  }
  std::printf("%zu lines, %.3f ms apart\n\n", log.joints.front().commanded.size(),
              1e3 * log.period);
  std::printf("%-8s %14s %10s %14s %14s  %s\n", "joint", "dead time [ms]", "lag [ms]",
              "response [ms]", "moved [mrad,mm]", "error [mrad,mm]");
  double longest = 0.0;
  bool is_sure = !found.empty();
  auto joints = nlohmann::ordered_json::array();
  for (const auto& [name, servo] : found) {
    std::printf("%-8s %14.1f %10.1f %14.1f %15.2f  %.3f%s\n", name.c_str(), 1e3 * servo.dead_time,
                1e3 * servo.lag, 1e3 * servo.response(), 1e3 * servo.moved, 1e3 * servo.error,
                servo.is_explained() ? "" : "  NOT EXPLAINED");
    longest = std::max(longest, servo.response());
    is_sure = is_sure && servo.is_explained();
    joints.push_back({{"joint", name},
                      {"dead_time_s", servo.dead_time},
                      {"lag_s", servo.lag},
                      {"response_s", servo.response()},
                      {"moved", servo.moved},
                      {"error", servo.error},
                      {"is_explained", servo.is_explained()}});
  }
  if (found.empty()) {
    std::puts("\nNo joint was commanded to move.");
  } else if (!is_sure) {
    std::puts("\nA joint did not follow its command as a dead time and a lag would.");
  } else {
    std::printf("\nIn a scene: robot: {admittance: {response: %.0f ms}}\n",
                std::ceil(1e3 * longest));
  }
  if (json.wanted()) {
    nlohmann::ordered_json report = {{"log", arguments.log}, {"period_s", log.period}};
    report["response_s"] = nullptr;
    if (is_sure) report["response_s"] = longest;
    report["joints"] = std::move(joints);
    host::write(report, json.stream());
    json.close();
  }
  return is_sure ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  return host::start(argc, argv, "step_response", "Measures how late a position servo is.", 2,
                     describe, run);
}
