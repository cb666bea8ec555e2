// SPDX-License-Identifier: BSD-3-Clause
// By hand: it sums the few lines below a bound, for which a fast transform computes all.
#include "spectrum.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numeric>
#include <vector>

#include <repel/base/setup_error.hpp>

namespace repel::telepresence {

double rms_above(std::span<const double> samples, double rate_hz, double above_hz) {
  const auto n = static_cast<double>(samples.size());
  const double mean = std::accumulate(samples.begin(), samples.end(), 0.0) / n;
  std::vector<double> windowed;
  double power = 0.0;   // of all lines
  double window = 0.0;  // mean square of the window, times n
  for (const double sample : samples) {
    const auto i = static_cast<double>(windowed.size());
    const double hann = 0.5 - 0.5 * std::cos(2.0 * M_PI * i / n);
    windowed.push_back(hann * (sample - mean));
    power += windowed.back() * windowed.back();
    window += hann * hann;
  }
  for (double line = 0.0; line * rate_hz <= above_hz * n; ++line) {
    std::complex<double> sum;
    const std::complex<double> turn = std::polar(1.0, -2.0 * M_PI * line / n);
    std::complex<double> phase = 1.0;
    for (const double value : windowed) {
      sum += value * phase;
      phase *= turn;
    }
    power -= (line > 0.0 ? 2.0 : 1.0) * std::norm(sum) / n;
  }
  return std::sqrt(std::max(0.0, power / window));
}

double largest_jump(std::span<const double> samples) {
  double jump = 0.0;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    jump = std::max(jump, std::abs(samples[i] - samples[i - 1]));
  }
  return jump;
}

std::string check_rms_above() {
  constexpr double rate_hz = 400.0;
  std::vector<double> signal;
  for (int i = 0; i < 400; ++i) {
    const double turn = 2.0 * M_PI * i / rate_hz;
    signal.push_back(20.0 + 5.0 * std::sin(1.3 * turn) + std::sin(25.7 * turn) +
                     0.3 * std::sin(42.4 * turn));
  }
  const double found = rms_above(signal, rate_hz, 30.0);
  if (std::abs(found / (0.3 * M_SQRT1_2) - 1.0) < 0.01) return {};
  return "a sine of 0.3 N is found as " + to_text(found) + " N";
}

}  // namespace repel::telepresence
