// SPDX-License-Identifier: BSD-3-Clause
// The signed distances of many pairs in a loop of C++: what the Python package is compared with.
//
//     loop PROBLEM ANSWERS REPEATS
//
// PROBLEM and ANSWERS are written and read by problem.py. Prints the least time of a pair [ns].
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

#include <repel/reduction/separation.hpp>
#include <repel/reduction/shape.hpp>

namespace {

using namespace repel;

template <class Number>
std::vector<Number> read(std::istream& file, std::size_t count) {
  std::vector<Number> numbers(count);
  file.read(reinterpret_cast<char*>(numbers.data()),
            static_cast<std::streamsize>(count * sizeof(Number)));
  return numbers;
}

Shape shape_from(std::int64_t kind, const std::vector<double>& size) {
  switch (kind) {
    case 0:
      return Shape::box({size[0], size[1], size[2]});
    case 1:
      return Shape::sphere(size[0]);
    case 2:
      return Shape::capsule(size[0], size[1]);
    case 3:
      return Shape::cylinder(size[0], size[1]);
    case 4:
      return Shape::cone(size[0], size[1]);
    default:
      break;
  }
  std::vector<Vec3> points;
  for (std::size_t i = 0; i + 2 < size.size(); i += 3) {
    points.emplace_back(size[i], size[i + 1], size[i + 2]);
  }
  return Shape::hull(points);
}

struct Problem {
  std::vector<Shape> shapes;
  std::vector<Pose> poses;
  std::vector<std::int64_t> pairs;
};

Problem read_problem(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  const auto counts = read<std::int64_t>(file, 2);
  Problem problem;
  for (std::int64_t i = 0; i < counts[0]; ++i) {
    const auto kind = read<std::int64_t>(file, 2);
    problem.shapes.push_back(
        shape_from(kind[0], read<double>(file, static_cast<std::size_t>(kind[1]))));
  }
  for (std::int64_t i = 0; i < counts[0]; ++i) {
    const auto rows = read<double>(file, 16);
    Pose X;
    for (int k = 0; k < 16; ++k) X.matrix()(k / 4, k % 4) = rows[static_cast<std::size_t>(k)];
    problem.poses.push_back(X);
  }
  problem.pairs = read<std::int64_t>(file, 2 * static_cast<std::size_t>(counts[1]));
  if (!file) throw std::runtime_error(path + " is no problem");
  return problem;
}

[[gnu::noinline]] Separation ask(const Shape& a, const Pose& X_WA, const Shape& b, const Pose& X_WB,
                                 WarmStart& warm) noexcept {
  return separation(a, X_WA, b, X_WB, {}, warm);
}

double time_of_a_pair(const Problem& problem, std::vector<Separation>& answers) {
  const auto begin = std::chrono::steady_clock::now();
  for (std::size_t i = 0; i < answers.size(); ++i) {
    WarmStart cold;
    const auto a = static_cast<std::size_t>(problem.pairs[2 * i]);
    const auto b = static_cast<std::size_t>(problem.pairs[2 * i + 1]);
    answers[i] =
        ask(problem.shapes[a], problem.poses[a], problem.shapes[b], problem.poses[b], cold);
  }
  const std::chrono::duration<double, std::nano> time = std::chrono::steady_clock::now() - begin;
  return time.count() / static_cast<double>(answers.size());
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) return 2;
  const Problem problem = read_problem(argv[1]);
  std::vector<Separation> answers(problem.pairs.size() / 2);
  double least = time_of_a_pair(problem, answers);
  for (int i = 1; i < std::stoi(argv[3]); ++i) {
    least = std::min(least, time_of_a_pair(problem, answers));
  }
  std::ofstream file(argv[2], std::ios::binary);
  for (const Separation& s : answers) {
    for (const double number :
         {s.distance, s.lower, s.upper, s.p_WA[0], s.p_WA[1], s.p_WA[2], s.p_WB[0], s.p_WB[1],
          s.p_WB[2], s.extraction_W[0], s.extraction_W[1], s.extraction_W[2]}) {
      file.write(reinterpret_cast<const char*>(&number), sizeof number);
    }
  }
  std::printf("%.17g\n", least);
  return file ? 0 : 1;
}
