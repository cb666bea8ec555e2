#include "part.hpp"

#include <unistd.h>

#include <array>
#include <cstdio>

namespace repel::telepresence {

std::span<const Part> parts() {
  static constexpr std::array<Part, 4> all{{
      {"delay", "a hard wall over a line: waves beside plain force and velocity", delay},
      {"transparency", "the impedance that the operator feels, against frequency", transparency},
      {"zwidth", "the stiffest wall without a limit cycle, against its damping", zwidth},
      {"hold", "how still a hard wall is held", hold},
  }};
  return all;
}

void progress(const char* part, std::size_t done, std::size_t of) {
  if (isatty(STDERR_FILENO) == 0 && done < of) return;
  std::fprintf(stderr, "\r%s: %zu of %zu%s", part, done, of, done < of ? "" : "\n");
}

}  // namespace repel::telepresence
