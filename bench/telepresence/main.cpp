// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Transparency of the network, and the limits of wall stiffness and delay.

#include "part.hpp"

namespace {

using namespace repel;

const bench::Program program{
    .name = "telepresence",
    .about =
        "What an operator feels through the network, and how stiff and how far away a wall "
        "may be.",
    .all = telepresence::parts(),
    .seeded = "Of the channels of the lines",
    .footer =
        "Everything is simulated: nothing waits for the clock, and a seed gives the same\n"
        "results again. Lengths are in m, forces in N and times in s unless a column says\n"
        "otherwise. docs/benchmarks.md says how to read the tables.",
    .scheduler = "simulated time"};

}  // namespace

int main(int argc, char** argv) {
  return bench::start<program>(argc, argv);
}
