// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// All fixed capacities of a world.
#pragma once

namespace repel {

/// Capacities of a world. Set-up that needs more throws SetupError naming the field to raise; no
/// container grows after set-up.
struct Capacities {
  int bodies = 64;           ///< rigid bodies, including the fixed one, without those below
  int loose = 256;           ///< parts that can come and go, each with a body of its own
  int parts = 20000;         ///< convex parts of all bodies
  int pairs = 1 << 20;       ///< pairs of parts
  int candidates = 1 << 14;  ///< pairs that can soon come within range, at one time; about 1 kB
                             ///< each
  int threads = 16;          ///< of the coprocessor
};

}  // namespace repel
