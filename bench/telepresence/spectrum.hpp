/// @file
/// The RMS of a signal above a frequency.
#pragma once

#include <span>
#include <string>

namespace repel::telepresence {

/// Root mean square of the content of `samples` above `above_hz`, up to `rate_hz` / 2. Their mean
/// is subtracted, a Hann window prevents leakage of slow motion, and their power is summed by
/// Parseval's theorem, minus that of the lines of the discrete Fourier transform at `above_hz` and
/// below. Accurate to 1 % for content more than two lines, 2 rate_hz / samples, away from
/// `above_hz`.
[[nodiscard]] double rms_above(std::span<const double> samples, double rate_hz, double above_hz);

/// Self-test: empty if rms_above finds a known sine in a signal with slower components; else the
/// value it found.
[[nodiscard]] std::string check_rms_above();

}  // namespace repel::telepresence
