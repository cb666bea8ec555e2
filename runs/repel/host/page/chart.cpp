// SPDX-License-Identifier: BSD-3-Clause
#include <repel/host/page/chart.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include <nlohmann/json.hpp>

#include <repel/base/setup_error.hpp>
#include <repel/host/page/page.hpp>

namespace repel::host {
namespace {

using page::escaped;

constexpr double width = 760.0;
constexpr double height = 180.0;
constexpr double left = 64.0;
constexpr double bottom = 24.0;
constexpr double top = 8.0;
constexpr std::size_t columns = 230;     // of the drawing without scripts
constexpr std::size_t intervals = 2000;  // of the data

/// Linear map from values to coordinates in the drawing.
struct Axis {
  double low, high;    ///< values
  double first, last;  ///< their coordinates

  [[nodiscard]] double operator()(double value) const {
    return first + (value - low) / (high - low) * (last - first);
  }
};

std::string number(double value, const char* format = "%.1f") {
  char text[32];
  (void)std::snprintf(text, sizeof text, format, value);
  return text;
}

/// A step of 1, 2 or 5 times a power of ten that divides `span` into at most `most` parts.
double step_for(double span, int most) {
  const double raw = span / most;
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  for (const double times : {1.0, 2.0, 5.0}) {
    if (times * power >= raw * (1.0 - 1e-9)) return times * power;
  }
  return 10.0 * power;
}

std::string line(double x1, double y1, double x2, double y2, const char* kind) {
  return std::string("<line class='") + kind + "' x1='" + number(x1) + "' y1='" + number(y1) +
         "' x2='" + number(x2) + "' y2='" + number(y2) + "'/>";
}
std::string label(double x, double y, const char* anchor, const std::string& text) {
  return std::string("<text text-anchor='") + anchor + "' x='" + number(x) + "' y='" + number(y) +
         "'>" + escaped(text) + "</text>";
}

/// The CSS class of a colour. Built by +=, because gcc 12 falsely warns of an overlap when a sum
/// begins with a literal (gcc bug 105651).
std::string class_of(std::size_t colour) {
  std::string name = "c";
  name += std::to_string(colour % 6);
  return name;
}

/// One step of an SVG path: M to move, L to draw a line.
std::string step_to(char how, double x, double y) {
  std::string text(1, how);
  text += number(x);
  text += ' ';
  text += number(y);
  return text;
}

std::string path_of(std::size_t colour, const std::string& d) {
  std::string html = "<path class='";
  html += class_of(colour) + "' d='" + d + "'/>";
  return html;
}

std::string legend(const std::vector<std::string>& names) {
  std::string html = "<p class='legend'>";
  for (std::size_t i = 0; i < names.size(); ++i) {
    html += "<span><i class='";
    html += class_of(i) + "'></i>" + escaped(names[i]) + "</span> ";
  }
  return html + "</p>";
}

/// @param data as JSON, for chart.js
std::string figure(const std::string& title, const std::string& data,
                   const std::string& legend_html, const std::string& drawing) {
  return "<figure data-chart=''><figcaption>" + escaped(title) +
         "</figcaption><div class='plot'></div><script type='application/json'>" + data +
         "</script><noscript>" + legend_html + "<svg role='img' aria-label='" + escaped(title) +
         "' viewBox='0 0 " + number(width) + " " + number(height) + "'>" + drawing +
         "</svg></noscript></figure>\n";
}

/// A number in JSON: null if it is none or too large for an axis.
std::string json_of(double value) {
  return std::abs(value) < 1e300 ? repel::to_text(value, 5) : "null";
}

std::string json_of(const std::vector<double>& values) {
  std::string json = "[";
  for (const double value : values) {
    if (json.size() > 1) json += ',';
    json += json_of(value);
  }
  return json + "]";
}

/// A text in JSON, within a <script> element.
std::string json_of(const std::string& text) {
  std::string json =
      nlohmann::json(text).dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
  for (auto at = json.find('<'); at != std::string::npos; at = json.find('<', at)) {
    json.replace(at, 1, "\\u003c");
  }
  return json;
}

/// What both kinds of charts have, without the braces.
template <class Curves, class ValuesOf>
std::string common_json(const char* kind, const std::string& unit, const Curves& curves,
                        const ValuesOf& values_of, const std::vector<double>& lines,
                        const std::vector<double>& marks) {
  std::string names;
  std::string values;
  for (const auto& curve : curves) {
    names += (names.empty() ? "" : ",") + json_of(curve.name);
    values += (values.empty() ? "" : ",") + json_of(values_of(curve));
  }
  std::string json = "\"kind\":\"";
  json += kind;
  json += "\",\"unit\":" + json_of(unit) + ",\"names\":[" + names + "],\"values\":[" + values +
          "],\"lines\":" + json_of(lines) + ",\"marks\":" + json_of(marks);
  return json;
}

/// All samples, or of each interval minimum and maximum in the order in which they came.
std::vector<double> thinned(const Curve& curve, std::size_t samples) {
  std::vector<double> values;
  if (samples <= 2 * intervals) {
    for (std::size_t i = 0; i < samples; ++i) values.push_back(curve.value(i));
    return values;
  }
  for (std::size_t k = 0; k < intervals; ++k) {
    double first = std::nan("");
    double second = first;
    bool rises = true;  // the minimum came first
    double least = std::numeric_limits<double>::infinity();
    double most = -least;
    const std::size_t end = (k + 1) * samples / intervals;
    for (std::size_t i = k * samples / intervals; i < end; ++i) {
      const double value = curve.value(i);
      if (!(std::abs(value) < 1e300)) continue;
      if (value < least) rises = false;
      if (value > most) rises = true;
      least = std::min(least, value);
      most = std::max(most, value);
    }
    if (least <= most) {
      first = rises ? least : most;
      second = rises ? most : least;
    }
    values.push_back(first);
    values.push_back(second);
  }
  return values;
}

std::string data_of(const Chart& chart) {
  std::string meanings;
  for (const Curve& curve : chart.curves) {
    meanings += (meanings.empty() ? "" : ",") + json_of(std::string(curve.meaning));
  }
  const bool is_thinned = chart.samples > 2 * intervals;
  const auto points = static_cast<double>(is_thinned ? 2 * intervals : chart.samples);
  const double step = chart.duration / std::max(1.0, is_thinned ? points : points - 1.0);
  return "{\"from\":" + json_of(is_thinned ? 0.5 * step : 0.0) +
         ",\"step\":" + repel::to_text(step, 9) + "," +
         common_json(
             "time", chart.unit, chart.curves,
             [&](const Curve& curve) { return thinned(curve, chart.samples); }, chart.lines,
             chart.marks) +
         ",\"even_to\":" + json_of(chart.even_to) + ",\"meanings\":[" + meanings + "]}";
}

/// All lines have the shares of the first.
std::string data_of(const PercentileChart& chart) {
  std::vector<double> shares;
  if (!chart.lines.empty()) {
    for (const Percentile& point : chart.lines.front().points) shares.push_back(point.share);
  }
  const auto values_of = [](const PercentileChart::Line& line) {
    std::vector<double> values;
    for (const Percentile& point : line.points) {
      values.push_back(point.us > 0.0 ? point.us : std::nan(""));
    }
    return values;
  };
  std::vector<double> lines;
  if (chart.deadline_us > 0.0) lines.push_back(chart.deadline_us);
  std::string text;
  for (const double share : shares) text += (text.empty() ? "" : ",") + repel::to_text(share, 7);
  return "{\"shares\":[" + text + "]," +
         common_json("share", "µs", chart.lines, values_of, lines, {}) + "}";
}

/// Minimum and maximum of a curve in each column; not finite for columns without a sample.
struct Band {
  std::vector<double> least, most;

  Band(const Curve& curve, std::size_t samples)
      : least(std::min(columns, samples), std::numeric_limits<double>::infinity()),
        most(least.size(), -std::numeric_limits<double>::infinity()) {
    for (std::size_t i = 0; i < samples; ++i) {
      const double value = curve.value(i);
      if (!(std::abs(value) < 1e300)) continue;  // also skips values too large for an axis
      const std::size_t column = i * least.size() / samples;
      least[column] = std::min(least[column], value);
      most[column] = std::max(most[column], value);
    }
  }

  /// A path through maximum and minimum of every column; columns without a value leave a gap.
  [[nodiscard]] std::string path(const Axis& y, std::size_t colour) const {
    std::string d;
    bool pen_up = true;
    for (std::size_t i = 0; i < least.size(); ++i) {
      if (!(least[i] <= most[i])) {
        pen_up = true;
        continue;
      }
      const double x = left + (width - left) * (static_cast<double>(i) + 0.5) /
                                  static_cast<double>(least.size());
      d += step_to(pen_up ? 'M' : 'L', x, y(most[i]));
      if (least[i] < most[i]) d += step_to('L', x, y(least[i]));
      pen_up = false;
    }
    return path_of(colour, d);
  }
};

/// The range of all bands and lines, with a small margin; never empty.
Axis value_axis(const Chart& chart, const std::vector<Band>& bands) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  const auto include = [&](double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  };
  for (const Band& band : bands) {
    for (std::size_t i = 0; i < band.least.size(); ++i) {
      if (!(band.least[i] <= band.most[i])) continue;
      include(band.least[i]);
      include(band.most[i]);
    }
  }
  for (const double value : chart.lines) include(value);
  if (!(low <= high)) low = high = 0.0;
  const double room = std::max(0.05 * (high - low), 1e-9 + 1e-6 * std::abs(high));
  return {low - room, high + room, height - bottom, top};
}

std::string grid(const Axis& y, const std::string& unit) {
  std::string html;
  const double step = step_for(y.high - y.low, 5);
  for (double value = std::ceil(y.low / step) * step; value <= y.high; value += step) {
    const double shown = std::abs(value) < 1e-9 * step ? 0.0 : value;
    html += line(left, y(value), width, y(value), "grid");
    html += label(left - 6.0, y(value) + 4.0, "end", repel::to_text(shown, 4));
  }
  return html + label(4.0, top + 8.0, "start", unit);
}

}  // namespace

std::string to_html(const Chart& chart) {
  std::vector<Band> bands;
  std::vector<std::string> names;
  for (const Curve& curve : chart.curves) {
    bands.emplace_back(curve, chart.samples);
    names.push_back(curve.name);
  }
  const Axis y = value_axis(chart, bands);
  const Axis x{0.0, std::max(chart.duration, 1e-9), left, width};
  std::string drawing = grid(y, chart.unit);
  for (const double time : chart.marks) {
    drawing += line(x(time), top, x(time), height - bottom, "mark");
  }
  for (const double value : chart.lines) drawing += line(left, y(value), width, y(value), "line");
  const double step = step_for(x.high, 10);
  for (double time = 0.0; time <= x.high * (1.0 + 1e-9); time += step) {
    const bool is_last = time + step > x.high * (1.0 + 1e-9);
    drawing += label(x(time), height - 6.0, is_last ? "end" : "middle",
                     repel::to_text(time, 4) + (is_last ? " s" : ""));
  }
  for (std::size_t i = 0; i < bands.size(); ++i) drawing += bands[i].path(y, i);
  return figure(chart.title, data_of(chart), names.size() > 1 ? legend(names) : "", drawing);
}

std::vector<Percentile> percentile_points(const DurationHistogram& times) {
  std::vector<Percentile> points;
  for (int tenth = 3; tenth <= 50; ++tenth) {
    const double share = 1.0 - std::pow(10.0, -0.1 * tenth);
    points.push_back({share, times.percentile_us(share)});
  }
  return points;
}

std::string to_html(const PercentileChart& chart) {
  double low = std::numeric_limits<double>::infinity();
  double high = chart.deadline_us;
  for (const PercentileChart::Line& each : chart.lines) {
    for (const Percentile& point : each.points) {
      if (point.us > 0.0) low = std::min(low, point.us);
      high = std::max(high, point.us);
    }
  }
  if (!(low < high)) low = 0.5 * std::max(high, 1.0);
  const Axis y{std::floor(std::log10(low)), std::log10(high) + 0.1, height - bottom, top};
  // Logarithmic in 1 - share: each decade of the remaining tail has the same width.
  const auto decades = [](double share) { return -std::log10(std::max(1.0 - share, 1e-5)); };
  const Axis x{decades(0.5), 5.0, left, width};
  std::string drawing = label(4.0, top + 8.0, "start", "µs");
  for (double decade = y.low; decade <= y.high; decade += 1.0) {
    drawing += line(left, y(decade), width, y(decade), "grid");
    drawing += label(left - 6.0, y(decade) + 4.0, "end", repel::to_text(std::pow(10.0, decade), 4));
  }
  for (const double share : {0.5, 0.9, 0.99, 0.999, 0.9999}) {
    drawing += label(x(decades(share)), height - 6.0, "middle",
                     std::string("p").append(repel::to_text(100.0 * share)));
  }
  drawing += label(width, height - 6.0, "end", "max");
  if (chart.deadline_us > 0.0) {
    const double at = y(std::log10(chart.deadline_us));
    drawing += line(left, at, width, at, "line") + label(width, at + 13.0, "end", "deadline");
  }
  std::vector<std::string> names;
  for (std::size_t i = 0; i < chart.lines.size(); ++i) {
    std::string d;
    for (const Percentile& point : chart.lines[i].points) {
      if (!(point.us > 0.0)) continue;
      d += step_to(d.empty() ? 'M' : 'L', x(decades(point.share)), y(std::log10(point.us)));
    }
    drawing += path_of(i, d);
    names.push_back(chart.lines[i].name);
  }
  return figure(chart.title, data_of(chart), legend(names), drawing);
}

}  // namespace repel::host
