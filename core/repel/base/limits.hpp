/// @file
/// Every capacity in one place.
#pragma once

namespace repel {

/// What a world may hold. Set-up that needs more throws SetupError naming the field to raise;
/// nothing grows after set-up.
struct Limits {
  int bodies = 64;           ///< rigid bodies, the fixed one included
  int parts = 20000;         ///< convex parts of all bodies
  int pairs = 1 << 20;       ///< pairs of parts
  int candidates = 1 << 14;  ///< pairs at a time that can soon come within range, shared out
                             ///< evenly over up to 8 blocks; for each about 1.2 kB
  int threads = 16;          ///< worker threads of the coprocessor
};

}  // namespace repel
