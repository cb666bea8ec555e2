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
                             ///< evenly over the blocks; for each about 1.2 kB
  /// Worker threads of the coprocessor. The pairs make as many blocks, up to 8, whose forces are
  /// bitwise the same whichever thread, or none, works on them; in a world with few near pairs
  /// fewer blocks are faster.
  int threads = 16;
};

}  // namespace repel
