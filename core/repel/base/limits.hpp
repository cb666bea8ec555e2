/// @file
/// All fixed capacities of a world.
#pragma once

namespace repel {

/// Capacities of a world. Set-up that needs more throws SetupError naming the field to raise; no
/// container grows after set-up.
struct Limits {
  int bodies = 64;           ///< rigid bodies, including the fixed one
  int parts = 20000;         ///< convex parts of all bodies
  int pairs = 1 << 20;       ///< pairs of parts
  int candidates = 1 << 14;  ///< pairs that can soon come within range, at one time; split evenly
                             ///< over the blocks; about 1.2 kB each
  /// Worker threads of the coprocessor. The pairs are split into as many blocks, at most 8. The
  /// forces are bitwise the same whichever thread processes a block, also without worker threads;
  /// in a world with few near pairs fewer blocks are faster.
  int threads = 16;
};

}  // namespace repel
