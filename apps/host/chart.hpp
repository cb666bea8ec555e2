/// @file
/// Curves as SVG, for pages that people read.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace repel::host {

/// A curve of a chart: a name, and a value for each sample; those that are not finite leave a gap.
struct Curve {
  std::string name;
  std::function<double(std::size_t)> value;
};

/// What a chart shows. Horizontal is time, the same for all curves.
struct Chart {
  std::string title;
  std::string unit{};       ///< of the values
  std::size_t samples = 0;  ///< of each curve
  double duration = 0.0;    ///< [s] from the first sample to the last
  std::vector<Curve> curves{};
  std::vector<double> lines{};  ///< values to mark by a line across
  std::vector<double> marks{};  ///< [s] times to mark, as where a phase begins
};

/// The chart as an element <figure> with its title and legend. Curves are drawn as the band between
/// their least and greatest value in each column, so that no peak is lost however long they are.
/// Colours are the classes c0, c1, ... of the page.
[[nodiscard]] std::string to_html(const Chart& chart);

/// A duration that a share of all samples does not exceed.
struct Percentile {
  double share = 0.0;  ///< 0 to 1
  double us = 0.0;     ///< [us]
};

/// Curves of percentiles, from the half to the last sample in 10^5, against a logarithmic duration.
struct PercentileChart {
  std::string title;
  struct Line {
    std::string name;
    std::vector<Percentile> points;
  };
  std::vector<Line> lines;
  double deadline_us = 0.0;  ///< marked by a line across
};

[[nodiscard]] std::string to_html(const PercentileChart& chart);

}  // namespace repel::host
