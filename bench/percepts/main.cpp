// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The time from a depth image to parts of a world, on one thread.

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <repel/common/deadline.hpp>
#include <repel/percepts/own_body.hpp>
#include <repel/percepts/perceived_parts.hpp>
#include <repel/reduction/separation.hpp>
#include <repel/reduction/shape.hpp>

#include "../parts.hpp"
#include "percepts/seen.hpp"

namespace {

using namespace repel;
using namespace repel::percepts;
using Clock = std::chrono::steady_clock;

/// What the camera looks at.
struct View {
  const char* name;
  std::vector<test::Ball> balls;
  std::vector<test::Plane> planes;
  double noise;  // [m]
};

std::vector<View> views() {
  const test::Plane wall{{0, 0, 1}, 2.0};
  const test::Plane floor{{0.1, 0.9, 0.4}, 0.9};
  std::vector<test::Ball> many;
  for (int i = 0; i < 12; ++i) {
    many.push_back({{0.25 * (i % 4) - 0.4, 0.25 * (i / 4) - 0.25, 1.2 + 0.03 * i}, 0.08});
  }
  return {{"wall", {}, {wall}, 0.0},
          {"floor and wall", {}, {wall, floor}, 0.0},
          {"floor and wall, noise of 1 mm", {}, {wall, floor}, 1e-3},
          {"12 balls before them, noise of 1 mm", many, {wall, floor}, 1e-3}};
}

/// [m] The farthest of some points from the cells of their pixels, which should contain them.
double worst_outside(const std::vector<float>& image, std::span<const Cell> cells,
                     const DepthCells& division) {
  const DepthCamera& camera = division.camera();
  std::vector<Shape> hulls;
  hulls.reserve(cells.size());
  for (const Cell& cell : cells) hulls.push_back(Shape::hull(cell.corners(camera), {.levels = 1}));
  const Shape point = Shape::sphere(0.0, {.levels = 1});
  double worst = 0.0;
  for (int v = 0; v < camera.height; v += 5) {
    for (int u = 0; u < camera.width; u += 5) {
      const float z = image[camera.at(u, v)];
      if (!camera.measures(z)) continue;
      double least = std::numeric_limits<double>::infinity();
      Pose X = Pose::Identity();
      X.translation() = static_cast<double>(z) * camera.ray(u, v);
      for (std::size_t i = 0; i < cells.size(); ++i) {
        const Cell& c = cells[i];
        if (u < c.u || u >= c.u + c.width || v < c.v || v >= c.v + c.height) continue;
        least = std::min(least, separation(point, X, hulls[i], Pose::Identity(), {}).distance);
      }
      worst = std::max(worst, least);
    }
  }
  return worst;
}

/// A world with room for what is seen.
struct Room {
  explicit Room(int reserved) {
    const BodyId tool = world.add_body("tool");
    world.join(tool, tool);
    const PartId finger = world.add_part(tool, "finger", Shape::sphere(0.02, {.levels = 1}));
    for (int i = 0; i < reserved; ++i) {
      const PartId part = world.reserve("seen", Shape::sphere(0.01, {.levels = 1}), 1.1);
      (void)world.add_pair(finger, part, {.range = 0.03});
    }
  }
  static Capacities limits() {
    Capacities limits;
    limits.loose = 2000;
    return limits;
  }
  World world{limits()};
};

bench::Result measure(const bench::Options& options) {
  bench::Result result;
  result.title = "From an image of 320 x 240 to parts";
  result.columns = {"view",
                    "pixels measured [%]",
                    "cells",
                    "kept of them [%]",
                    "divide p50 [ms]",
                    "own body p50 [ms]",
                    "parts p50 [ms]",
                    "whole p50 [ms]",
                    "whole p99 [ms]"};
  const DepthCamera camera;
  const int images = options.quick ? 5 : 300;
  const std::vector<Shape> arm(8, Shape::capsule(0.05, 0.2, {.levels = 1}));
  std::vector<Pose> X_CP;
  for (int i = 0; i < 8; ++i) {
    X_CP.emplace_back(Eigen::Translation3d(-0.3 + 0.02 * i, 0.1 * i - 0.4, 0.7));
  }
  const OwnBody own(camera, arm);
  for (const View& view : views()) {
    std::mt19937 random(static_cast<unsigned>(options.seed));
    Room room(800);
    Coprocessor coprocessor(room.world, {});
    WorldChanges changes(room.world, 4096);
    DepthCells division(camera, {.most = 300});
    PerceivedParts parts(changes);
    DurationHistogram divide, filter, update, whole;
    const std::vector<float> clean = test::depths(camera, view.balls, view.planes);
    std::int64_t kept = 0;
    std::int64_t cells = 0;
    double outside = 0.0;
    for (int i = 0; i < images; ++i) {
      std::vector<float> image = clean;
      test::spoil(image, view.noise, view.noise > 0.0 ? 0.02 : 0.0, random);
      const auto begin = Clock::now();
      (void)own.remove(X_CP, image);
      const auto filtered = Clock::now();
      const auto found = division.divide(image);
      const auto divided = Clock::now();
      const PerceptCounts counts = parts.see(found, division, Pose::Identity(), i / 30.0);
      const auto end = Clock::now();
      filter.record(filtered - begin);
      divide.record(divided - filtered);
      update.record(end - divided);
      whole.record(end - begin);
      if (i == 0) outside = worst_outside(image, found, division);
      cells += counts.cells;
      if (i > 0) kept += counts.kept;
      if (counts.left_out > 0) result.fail(view.name, "no reserved part was left");
      for (int tick = 0; tick < 40; ++tick) {
        changes.apply(room.world, coprocessor, 4096);
        room.world.advance(1.0 / 400.0);
        (void)coprocessor.exchange();
      }
    }
    if (!(outside <= 1e-6)) {
      result.fail(view.name, "a point is " + std::to_string(outside) + " m outside of the cells");
    }
    const auto ms = [](const DurationHistogram& times, double share) {
      return std::round(1e-1 * times.percentile_us(share)) / 1e2;
    };
    const double mean = static_cast<double>(cells) / images;
    const double later = mean * (images - 1);
    result.rows.push_back(
        {view.name,
         std::round(1e2 * division.report().measured / static_cast<double>(camera.pixels())),
         std::round(mean), std::round(1e2 * static_cast<double>(kept) / later), ms(divide, 0.5),
         ms(filter, 0.5), ms(update, 0.5), ms(whole, 0.5), ms(whole, 0.99)});
    bench::progress("images", result.rows.size(), views().size());
  }
  result.notes = {
      "Checked first: of every fifth row and column, each point measured lies in a cell, within a "
      "micrometre.",
      "`own body`: eight capsules are taken out of the image. `parts`: shapes are built and "
      "queued; "
      "what is kept costs none. The time of the ticks is not in it."};
  return result;
}

constexpr std::array<bench::Part, 1> all{
    bench::Part{"images", "from a depth image to parts of a world", measure}};
constexpr bench::Program program{"percepts",
                                 "The time from a depth image to parts of a world, on one thread.",
                                 all,
                                 "the noise of the camera",
                                 "A camera of 30 Hz leaves 33 ms for an image.",
                                 "none"};

}  // namespace

int main(int argc, char** argv) {
  return repel::bench::start<program>(argc, argv);
}
