// SPDX-License-Identifier: BSD-3-Clause
// rejected by concurrency-mt-unsafe
#include <cstdlib>
int roll() { return std::rand(); }
