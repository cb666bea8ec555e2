// SPDX-License-Identifier: BSD-3-Clause
// figures FOLDER: computes the figures of docs/reduction.md, control.md, walls.md and
// network/guide.md. Writes the curves to FOLDER as CSV and prints the tables.
#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>
#include <vector>

#include "motions.hpp"
#include "passages.hpp"
#include "plates.hpp"
#include "pulls.hpp"
#include "pushed_walls.hpp"
#include "settled.hpp"

namespace {

using namespace repel;
using namespace repel::figures;

constexpr double degree = std::numbers::pi / 180.0;

struct Series {
  const char* name;
  Measure measure;
  int levels;
};
constexpr Series all_series[] = {{"2 levels", Measure::reduction, 2},
                                 {"8 levels", Measure::reduction, 8},
                                 {"32 levels", Measure::reduction, 32},
                                 {"deepest point", Measure::deepest_point, 8}};

std::ofstream csv(const std::filesystem::path& path, const char* header) {
  std::ofstream file;
  file.exceptions(std::ios::failbit | std::ios::badbit);
  file.open(path);
  file << header << '\n';
  return file;
}

void write_curves(std::ostream& file, const std::string& motion_name, auto&& motion_of) {
  for (const Series& series : all_series) {
    for (const Sample& s : answers_along(motion_of(series.levels), series.measure, 2800)) {
      file << motion_name << ',' << series.name << ',' << 1e3 * s.position << ','
           << 1e3 * s.distance() << ',' << s.direction() << '\n';
    }
  }
}

/// The corners of the cross section, counter-clockwise.
void write_outline(std::ostream& file, const std::string& name, const Shape& shape,
                   const Pose& X_W) {
  const Convex& core = shape.level(0).core;
  std::vector<Vec3> corners;
  for (int i = 0; i < core.vertex_count(); ++i) {
    const Vec3 p = to_vec3(core.point(static_cast<std::uint32_t>(i)).p);
    if (p.z() < 0.0) corners.push_back(p);
  }
  std::sort(corners.begin(), corners.end(), [](const Vec3& a, const Vec3& b) {
    return std::atan2(a.y(), a.x()) < std::atan2(b.y(), b.x());
  });
  for (const Vec3& corner : corners) {
    const Vec3 p = X_W * corner;
    file << name << ',' << 1e3 * p.x() << ',' << 1e3 * p.y() << '\n';
  }
}

void write_motions(const std::filesystem::path& folder) {
  std::ofstream curves =
      csv(folder / "motions.csv", "motion,series,position_mm,distance_mm,direction_deg");
  std::ofstream outlines = csv(folder / "outlines.csv", "motion,shape,x_mm,y_mm");
  const auto write = [&](const std::string& name, auto&& motion_of) {
    write_curves(curves, name, motion_of);
    const figures::Motion motion = motion_of(8);
    write_outline(outlines, name + ",A", motion.A, motion.X_WA);
    write_outline(outlines, name + ",B", motion.B, Pose::Identity());
  };
  write("box", [](int levels) { return into_a_box(levels); });
  write("turned box", [](int levels) { return into_a_box(levels, 20.0 * degree); });
  write("triangle", [](int levels) { return through_a_rectangle(levels); });
}

void print_equidistance_regions() {
  std::puts("## Equidistance regions\n\n| levels | widest |\n|---|---|");
  for (const int levels : {2, 4, 8, 16, 32, 64}) {
    const auto samples = answers_along(through_a_rectangle(levels), Measure::reduction, 22000);
    std::printf("| %d | %.1f mm |\n", levels, 1e3 * widest_flat(samples));
  }
}

struct Run {
  const char* name;
  PlatesOptions options;
};
constexpr Run runs[] = {
    {"bare, 20 N", {}},
    {"bare, 150 N", {.press = 150.0}},
    {"held, 20 N", {.held = true}},
    {"held, 150 N", {.press = 150.0, .held = true}},
    {"held, 150 N, deepest point",
     {.measure = Measure::deepest_point, .press = 150.0, .held = true}},
};
constexpr const char* witnesses[] = {"plain", "filtered", "averaged"};

std::string shown(double value, const char* unit) {
  if (value < 1e-6) return "0";
  char digits[32];
  std::snprintf(digits, sizeof digits, "%.2g %s", value, unit);
  return digits;
}

void print_row(const char* run, double rate, const char* witness, const Settled& s) {
  std::printf("| %s | %.0f Hz | %s | ", run, rate, witness);
  if (s.tilt > 90.0 * degree) {
    std::puts("turns over | | | |");
    return;
  }
  std::printf("%s | %s | %s | %s |\n", shown(s.tilt / degree, "deg").c_str(),
              shown(s.chatter, "N").c_str(), shown(s.torque_jump, "N m").c_str(),
              shown(s.pushed_tilt / degree, "deg").c_str());
}

void write_plates(const std::filesystem::path& folder) {
  std::ofstream file = csv(folder / "plates.csv", "run,rate_hz,witness,time_s,tilt_deg,torque_nm");
  std::puts(
      "\n## Parallel plates\n\n| plate | loop | witness | tilt | chatter | torque jump | tilt by "
      "the push |\n"
      "|---|---|---|---|---|---|---|");
  for (const Run& run : runs) {
    for (const double rate : {400.0, 1000.0}) {
      for (int witness = 0; witness < 3; ++witness) {
        PlatesOptions options = run.options;
        options.witness = static_cast<Witness>(witness);
        options.rate = rate;
        const std::vector<PlatesTick> ticks = Plates(options).run();
        for (const PlatesTick& tick : ticks) {
          file << '"' << run.name << "\"," << rate << ',' << witnesses[witness] << ',' << tick.time
               << ',' << tick.tilt / degree << ',' << tick.F_W.torque.x() << '\n';
        }
        print_row(run.name, rate, witnesses[witness], settled(ticks, rate));
      }
    }
  }
}

void write_passages(const std::filesystem::path& folder) {
  std::ofstream file = csv(folder / "passages.csv", "body,law,height_mm,up_n,aside_n");
  for (const Crossing& crossing : crossings()) {
    for (const bool passable : {false, true}) {
      for (const CrossingForce& at : forces_along(crossing, passable)) {
        file << crossing.name << ',' << (passable ? "passable" : "ceiling only") << ','
             << 1e3 * at.height << ',' << at.f_W.z() << ',' << at.f_W.x() << '\n';
      }
    }
  }
}

void write_walls(const std::filesystem::path& folder) {
  std::ofstream file = csv(folder / "walls.csv", "wall,hand_mm,ball_mm,felt_n");
  for (const Pushed& wall : pushed_walls()) {
    for (const PushedBall& at : push_ball(wall.law)) {
      file << wall.name << ',' << 1e3 * at.hand << ',' << 1e3 * at.ball << ',' << at.force << '\n';
    }
  }
}

void write_pulls(const std::filesystem::path& folder) {
  std::ofstream file = csv(folder / "pulls.csv", "what,fixture,distance_mm,force_n,energy_j");
  const auto write = [&](const char* what, const std::vector<Pulled>& all) {
    for (const Pulled& each : all) {
      for (const Pull& at : pull_out(each)) {
        file << what << ",\"" << each.name << "\"," << 1e3 * at.distance << ',' << at.force << ','
             << at.energy << '\n';
      }
    }
  };
  write("limit", pulled_by_limit());
  write("shape", pulled_by_shape());
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 2 || argv[1][0] == '-' || argv[1][0] == '\0') {
    std::fputs("figures FOLDER: writes the curves of the pictures to FOLDER as CSV\n", stderr);
    return argc == 2 && std::string(argv[1]) == "--help" ? 0 : 2;
  }
  const std::filesystem::path folder = argv[1];
  std::filesystem::create_directories(folder);
  write_motions(folder);
  print_equidistance_regions();
  write_plates(folder);
  write_passages(folder);
  write_walls(folder);
  write_pulls(folder);
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "figures: %s\n", error.what());
  return 1;
}
