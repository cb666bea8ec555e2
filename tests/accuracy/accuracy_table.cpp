// SPDX-License-Identifier: BSD-3-Clause
// Measures the accuracy for every pair of shape kinds against 113-bit references, compares it with
// the guaranteed limits, and writes or checks the page that states it.
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <accuracy/cell.hpp>
#include <accuracy/command_line.hpp>

namespace repel::accuracy {
namespace {

constexpr std::array<double, 4> gaps{1.0, 1e-3, 1e-6, 1e-9};  // [m]
constexpr const char* worst_case_heading = "\n## Worst case";
constexpr int specimens = 4;  // of each kind

/// The guaranteed limits for every pair of kinds at every gap.
struct Promise {
  double absolute;  ///< error relative to the larger size
  double relative;  ///< error relative to the distance
  double width;     ///< width of the bracket relative to the larger size
};
constexpr Promise promise{2e-14, 2e-6, 1e-13};

constexpr std::pair<Measure, const char*> measures[] = {{Measure::deepest_point, "deepest_point"},
                                                        {Measure::reduction, "reduction"},
                                                        {Measure::exact, "exact"}};

std::string name_of(Measure measure) {
  for (const auto& [value, name] : measures) {
    if (value == measure) return name;
  }
  return "";
}

/// The measure of that name; ends the program if there is none.
Measure measure_called(const std::string& name) {
  for (const auto& [value, known] : measures) {
    if (name == known) return value;
  }
  std::fprintf(stderr, "--measure: not understood: %s; allowed:", name.c_str());
  for (const auto& [value, known] : measures) std::fprintf(stderr, " %s", known);
  std::fprintf(stderr, "\n");
  std::exit(2);
}

std::string text(const char* format, double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, format, value);
  return buffer;
}

/// The pairs of kinds, each with one cell for every gap and one for overlap.
struct Table {
  struct Row {
    std::string a, b;
    std::array<Cell, gaps.size()> apart;
    Cell overlap;
  };
  std::vector<Row> rows;
  Measure measure;  ///< of the overlap

  Table(int samples, Measure by) : measure(by) {
    Rng rng(1993);
    std::map<std::string, std::vector<Specimen>> made;
    for (const std::string& kind : kinds()) {
      for (int i = 0; i < specimens; ++i) made[kind].push_back(make(kind, rng));
    }
    for (std::size_t a = 0; a < kinds().size(); ++a) {
      for (std::size_t b = a; b < kinds().size(); ++b) {
        rows.push_back(measured(made[kinds()[a]], made[kinds()[b]], samples, rng));
      }
    }
  }

  [[nodiscard]] Row measured(const std::vector<Specimen>& A, const std::vector<Specimen>& B,
                             int samples, Rng& rng) const {
    Row row{A[0].kind, B[0].kind, {}, {}};
    std::fprintf(stderr, "%s, %s\n", row.a.c_str(), row.b.c_str());
    for (int i = 0; i < samples; ++i) {
      const Specimen& one = A[i % specimens];
      const Specimen& other = B[i / specimens % specimens];
      for (std::size_t g = 0; g < gaps.size(); ++g) {
        add_apart(row.apart[g], one, other, gaps[g], rng);
      }
      add_overlapping(row.overlap, one, other, measure, rng);
    }
    return row;
  }

  /// Number of violated limits; each is printed.
  [[nodiscard]] int broken() const {
    int count = 0;
    const auto keep = [&](const Row& row, const char* what, double measured, double allowed) {
      if (measured <= allowed) return;
      ++count;
      std::printf("%s, %s: %s is %.3g, promised is %.3g\n", row.a.c_str(), row.b.c_str(), what,
                  measured, allowed);
    };
    for (const Row& row : rows) {
      for (std::size_t g = 0; g < gaps.size(); ++g) {
        const Cell& cell = row.apart[g];
        keep(row, "wrong brackets", cell.misses, 0);
        keep(row, "the error over the size", cell.absolute, promise.absolute);
        keep(row, "the error over the distance", cell.relative, promise.relative);
        keep(row, "the bracket over the size", cell.width, promise.width);
      }
      keep(row, "wrong brackets in overlap", row.overlap.misses, 0);
    }
    return count;
  }

  /// One line for each pair of kinds; `print` formats a cell.
  template <class Print>
  [[nodiscard]] std::string section(const std::string& title, Print&& print) const {
    std::string page = "\n## " + title + "\n\n| shapes | 1 m | 1 mm | 1 um | 1 nm |\n";
    page += "|---|---|---|---|---|\n";
    for (const Row& row : rows) {
      page += "| " + row.a + ", " + row.b;
      for (const Cell& cell : row.apart) page += " | " + print(cell);
      page += " |\n";
    }
    return page;
  }

  [[nodiscard]] std::string overlap_section() const {
    std::string page =
        "\n## In deep overlap\n\n"
        "The distance is the intrusion distance of the measure `" +
        name_of(measure) +
        "`,\nwith the default number of levels (hulls: 4). It is compared with the least overlap\n"
        "found over many directions.\n\n"
        "| shapes | share of the depth, median | least | widest bracket, of the larger size | "
        "iterations |\n|---|---|---|---|---|\n";
    for (const Row& row : rows) {
      const Cell& cell = row.overlap;
      page += "| " + row.a + ", " + row.b + " | " + text("%.2f", median(cell.shares)) + " | " +
              text("%.2f", cell.least_share) + " | " + text("%.2g", cell.width) + " | " +
              std::to_string(median(cell.iterations)) + " / " +
              std::to_string(cell.most_iterations()) + " |\n";
    }
    return page;
  }
};

/// The part of the page that a run must reproduce.
std::string promised() {
  return "| shapes | gaps from | error, of the larger size | error, of the distance | width of the "
         "bracket, of the larger size |\n|---|---|---|---|---|\n| all | " +
         text("%.0e", gaps.back()) + " m | " + text("%.0e", promise.absolute) + " | " +
         text("%.0e", promise.relative) + " | " + text("%.0e", promise.width) + " |\n";
}

std::string page_of(const Table& table, int samples) {
  std::string page =
      // In two pieces, for who looks for the licence of this file.
      "<!-- SPDX-"
      "License-Identifier: BSD-3-Clause -->\n\n"
      "# Accuracy\n\n"
      "Measured errors of `separation` for every pair of shapes. This page is written by\n"
      "`accuracy_table --measure " +
      name_of(table.measure) +
      " --write docs/accuracy.md`; the tests repeat the\n"
      "measurement by the default measure and compare it with the guarantees. The size of a\n"
      "shape is the distance of its farthest point from its origin, here 0.3 to 1 m. Reference\n"
      "distances are computed with 113 bits and certified by their duality gap.\n\n"
      "## Guarantees\n\nThe true distance always lies in the bracket. In addition:\n\n";
  page += promised();
  page += "\nEach entry below is the worst of " + std::to_string(samples) +
          " poses: a third of them at random attitudes, a third with the\naxes of the two shapes "
          "aligned, a third within 1e-12 to 1e-3 rad of that. Columns are gaps.\n";
  page += table.section("Error over the larger size",
                        [](const Cell& c) { return text("%.1e", c.absolute); });
  page += table.section("Error over the distance",
                        [](const Cell& c) { return text("%.1e", c.relative); });
  page += table.section("Width of the bracket over the larger size",
                        [](const Cell& c) { return text("%.1e", c.width); });
  page += table.section("Iterations from a cold start: median / maximum", [](const Cell& c) {
    return std::to_string(median(c.iterations)) + " / " + std::to_string(c.most_iterations());
  });
  return page + table.overlap_section();
}

std::string content(const std::string& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

int main(int argc, char** argv) {
  double samples = 48;
  std::string write;
  std::string check;
  std::string measure = name_of(QueryOptions{}.measure);
  read_command_line(
      argc, argv, "Measures the accuracy of separation() for every pair of kinds of shapes.",
      {{"--samples", "poses of each pair of kinds and gap", &samples, nullptr, 1.0, 1e6},
       {"--measure", "of the overlap: deepest_point, reduction or exact", nullptr, &measure},
       {"--write", "the page to write", nullptr, &write},
       {"--check", "the page whose promises must be these", nullptr, &check}});
  const Table table(static_cast<int>(samples), measure_called(measure));
  if (table.broken() > 0) return 1;
  if (!check.empty() && content(check).find(promised()) == std::string::npos) {
    std::printf("%s promises something else; write it again with --write\n", check.c_str());
    return 1;
  }
  if (!write.empty()) {
    // The text after the tables, written by other programs, is kept.
    const std::string kept = content(write);
    const std::size_t behind = kept.find(worst_case_heading);
    std::ofstream(write) << page_of(table, static_cast<int>(samples))
                         << (behind == std::string::npos ? "" : kept.substr(behind));
  }
  std::printf("every promise is kept\n");
  return 0;
}

}  // namespace
}  // namespace repel::accuracy

int main(int argc, char** argv) {
  return repel::accuracy::main(argc, argv);
}
