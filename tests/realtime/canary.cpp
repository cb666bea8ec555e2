// SPDX-License-Identifier: BSD-3-Clause
// Performs every operation forbidden in a tick; symbols.sh must reject this object for each of
// them.
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <stdexcept>
#include <vector>

namespace repel::test {

std::mutex mutex;

double* forbidden(std::vector<double>& grows, double*& old, void*& raw) {
  const std::lock_guard<std::mutex> lock(mutex);
  grows.push_back(1.0);
  std::free(raw);
  raw = std::malloc(grows.size());
  std::puts("ticking");
  usleep(1);
  if (raw == nullptr) throw std::runtime_error("no memory");
  delete[] old;
  return new double[grows.size()];
}

}  // namespace repel::test
