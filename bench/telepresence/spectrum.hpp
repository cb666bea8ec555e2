// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// How rough a signal is: its RMS above a frequency, and its jumps.
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

/// Largest change from one sample to the next, without sign; 0 for fewer than two samples.
[[nodiscard]] double largest_jump(std::span<const double> samples);

/// Self-test: empty if rms_above finds a known sine in a signal with slower components; else the
/// value it found.
[[nodiscard]] std::string check_rms_above();

}  // namespace repel::telepresence
