// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Curves for HTML pages: drawn by uPlot, to point at and to zoom; by SVG where no script runs, as
/// in mail programs and previews.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include <repel/common/deadline.hpp>

namespace repel::host {

/// A curve of a chart: a name, and a value for each sample. Values that are not finite leave a gap.
struct Curve {
  std::string name;
  std::function<double(std::size_t)> value;
  std::string_view meaning{};  ///< of the name, shown at the pointer; empty: nothing
};

/// The content of a chart. The horizontal axis is time, shared by all curves.
struct Chart {
  std::string title;
  std::string unit{};       ///< of the values
  std::size_t samples = 0;  ///< of each curve
  double duration = 0.0;    ///< [s] from the first sample to the last
  std::vector<Curve> curves{};
  std::vector<double> lines{};  ///< values marked by a horizontal line
  std::vector<double> marks{};  ///< [s] times marked by a vertical line, such as phase starts
  /// Up to here the vertical axis is even, and ever narrower beyond; 0: it is even everywhere.
  double even_to = 0.0;
};

/// The chart as a <figure> element with title, data and legend, drawn by the scripts of
/// page::end(). Up to 4000 samples are there as they are. Of more, each of 2000 intervals has the
/// minimum and the maximum of each curve, so that no peak is lost however many samples there are,
/// and the page stays small. Five significant digits. The colours are the CSS classes c0, c1, ...
/// of the page.
[[nodiscard]] std::string to_html(const Chart& chart);

/// A duration that a share of all samples does not exceed.
struct Percentile {
  double share = 0.0;  ///< 0 to 1
  double us = 0.0;     ///< [us]
};

/// From the median to the share 1 - 10^-5, in tenths of a decade of the rest.
[[nodiscard]] std::vector<Percentile> percentile_points(const DurationHistogram& times);

/// Percentile curves, from the median to the share 1 - 10^-5, against the duration on a logarithmic
/// axis. All lines have points at the same shares.
struct PercentileChart {
  std::string title;
  struct Line {
    std::string name;
    std::vector<Percentile> points;
  };
  std::vector<Line> lines;
  double deadline_us = 0.0;  ///< marked by a horizontal line
};

[[nodiscard]] std::string to_html(const PercentileChart& chart);

}  // namespace repel::host
