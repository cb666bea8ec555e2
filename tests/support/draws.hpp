// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Number of draws of a random test.
#pragma once

namespace repel::families {

/// `n`, or a twentieth of it under a sanitizer: it looks for memory and arithmetic errors, which
/// few draws reveal, and makes every draw ten times slower. Use it for the draws of a test and for
/// the expected size of its samples.
constexpr int draws(int n) {
#ifdef REPEL_SANITIZED
  return n / 20;
#else
  return n;
#endif
}

}  // namespace repel::families
