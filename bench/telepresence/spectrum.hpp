/// @file
/// How much of a signal is above a frequency.
#pragma once

#include <span>
#include <string>

namespace repel::telepresence {

/// Root mean square of what `samples` have above `above_hz`, to half of `rate_hz`. Without their
/// mean, and under a Hann window so that slow motion does not leak upward, their power is summed by
/// Parseval's theorem, less that of the lines of the discrete Fourier transform at `above_hz` and
/// below. Right to 1 % for what is more than two lines, 2 rate_hz / samples, away from `above_hz`.
[[nodiscard]] double rms_above(std::span<const double> samples, double rate_hz, double above_hz);

/// Empty when rms_above finds a known sine in a signal that has slower ones; else what it found.
[[nodiscard]] std::string check_rms_above();

}  // namespace repel::telepresence
