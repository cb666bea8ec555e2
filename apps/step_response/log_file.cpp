// SPDX-License-Identifier: BSD-3-Clause
#include "log_file.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <optional>
#include <sstream>
#include <string_view>

#include <repel/base/setup_error.hpp>
#include <repel/common/text_file.hpp>

namespace repel {

namespace {

constexpr std::string_view dividers = ",;\t \r";

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  for (std::size_t at = line.find_first_not_of(dividers); at != std::string_view::npos;
       at = line.find_first_not_of(dividers, at)) {
    const std::size_t end = std::min(line.find_first_of(dividers, at), line.size());
    words.push_back(line.substr(at, end - at));
    at = end;
  }
  return words;
}

std::optional<double> number_of(std::string_view word) {
  double value = 0.0;
  const auto [rest, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || rest != word.data() + word.size()) return std::nullopt;
  if (!std::isfinite(value)) return std::nullopt;
  return value;
}

/// The columns of a joint, from 0.
struct Place {
  std::size_t commanded, measured;
};

class Reader {
 public:
  Reader(std::string path, const LogColumns& columns, double rate)
      : path_(std::move(path)), columns_(columns), rate_(rate) {}

  PositionLog read() {
    std::istringstream text(text_of_file(path_, "a log of positions"));
    std::string line;
    while (std::getline(text, line)) {
      ++line_;
      const std::vector<std::string_view> words = words_of(line);
      if (words.empty()) continue;
      if (names_.empty()) {
        read_names(words);
      } else {
        read_numbers(words);
      }
    }
    if (names_.empty()) fail("the file is empty; allowed: a line of names, then numbers");
    log_.period = rate_ > 0.0 ? 1.0 / rate_ : even_period();
    return std::move(log_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw SetupError(what, path_, static_cast<int>(line_));
  }

  [[nodiscard]] std::optional<std::size_t> column(const std::string& name) const {
    const auto found = std::find(names_.begin(), names_.end(), name);
    if (found == names_.end()) return std::nullopt;
    return static_cast<std::size_t>(found - names_.begin());
  }

  void read_names(const std::vector<std::string_view>& words) {
    names_.assign(words.begin(), words.end());
    if (rate_ == 0.0) {
      const auto found = column(columns_.time);
      if (!found) fail("no column '" + columns_.time + "'; allowed: with one, or with a rate");
      time_ = *found;
    }
    for (std::size_t i = 0; i < names_.size(); ++i) {
      if (names_[i].rfind(columns_.commanded, 0) != 0) continue;
      const std::string number = names_[i].substr(columns_.commanded.size());
      if (!number.empty() && number.front() != '_') continue;
      const auto measured = column(columns_.measured + number);
      if (!measured)
        fail("no column '" + columns_.measured + number + "' beside '" + names_[i] + "'");
      places_.push_back({i, *measured});
      log_.joints.push_back({number.empty() ? number : number.substr(1), {}, {}});
    }
    if (places_.empty()) {
      fail("no column '" + columns_.commanded + "' or '" + columns_.commanded +
           "_...'; --commanded says how they are called");
    }
  }

  void read_numbers(const std::vector<std::string_view>& words) {
    if (words.size() != names_.size()) {
      fail(std::to_string(words.size()) + " columns; allowed: " + std::to_string(names_.size()) +
           ", as many as names");
    }
    const auto at = [&](std::size_t column) {
      const auto value = number_of(words[column]);
      if (!value)
        fail("'" + std::string(words[column]) + "' in column '" + names_[column] +
             "' is not a finite number");
      return *value;
    };
    for (std::size_t i = 0; i < places_.size(); ++i) {
      log_.joints[i].commanded.push_back(at(places_[i].commanded));
      log_.joints[i].measured.push_back(at(places_[i].measured));
    }
    if (rate_ == 0.0) times_.push_back(at(time_));
    lines_.push_back(line_);
  }

  /// [s] The mean time between lines, none of which is off by more than a half.
  [[nodiscard]] double even_period() {
    if (times_.size() < 2) fail("fewer than two lines of numbers");
    const double mean = (times_.back() - times_.front()) / static_cast<double>(times_.size() - 1);
    for (std::size_t k = 1; k < times_.size(); ++k) {
      const double step = times_[k] - times_[k - 1];
      if (std::abs(step - mean) <= 0.5 * mean) continue;
      line_ = lines_[k];
      fail("the time is " + to_text(step) + " s after the line before, and " + to_text(mean) +
           " s on average; allowed: even times, none missing");
    }
    return mean;
  }

  std::string path_;
  LogColumns columns_;
  double rate_;
  std::size_t line_ = 0;
  std::vector<std::string> names_;
  std::size_t time_ = 0;
  std::vector<Place> places_;
  std::vector<double> times_;
  std::vector<std::size_t> lines_;
  PositionLog log_;
};

}  // namespace

PositionLog read_position_log(const std::string& path, const LogColumns& columns, double rate) {
  return Reader(path, columns, rate).read();
}

}  // namespace repel
