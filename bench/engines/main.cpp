// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Speed and accuracy of the simulated arms, engine by engine.

#include <array>

#include "part.hpp"

namespace {

using namespace repel;

constexpr std::array parts{
    bench::Part{"sweep", "run time against the error of a motion, over sub-steps", engines::sweep},
    bench::Part{"energy", "what arms without friction gain or lose in a minute", engines::energy},
    bench::Part{"period", "of a pendulum, against the elliptic integral", engines::swing_period},
    bench::Part{"gravity", "what holds a PUMA still, against the published constants",
                engines::gravity},
};

const bench::Program program{
    .name = "engines",
    .about = "How fast and how right the simulated arms are, engine by engine.",
    .all = parts,
    .seeded = "Of the poses of gravity and the order of the timed runs",
    .footer =
        "Steps are of 2.5 ms and divided into sub-steps. All but the times is the same again\n"
        "with the same seed. docs/benchmarks.md says how to read the tables.",
    .scheduler = "as any program"};

}  // namespace

int main(int argc, char** argv) {
  return bench::start<program>(argc, argv);
}
