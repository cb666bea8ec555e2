/// @file
/// How often a random test draws.
#pragma once

namespace repel::families {

/// `n`, or one in twenty of it under a sanitizer: it looks for faults of memory and arithmetic,
/// which few draws show, and makes every draw ten times slower. For the draws of a test and for
/// what it then expects of the sample.
constexpr int draws(int n) {
#ifdef REPEL_SANITIZED
  return n / 20;
#else
  return n;
#endif
}

}  // namespace repel::families
