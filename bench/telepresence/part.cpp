// SPDX-License-Identifier: BSD-3-Clause
#include "part.hpp"

#include <array>

namespace repel::telepresence {

std::span<const Part> parts() {
  static constexpr std::array all{
      Part{"delay", "a hard wall over a line: waves beside plain force and velocity", delay},
      Part{"transparency", "the impedance that the operator feels, against frequency",
           transparency},
      Part{"zwidth", "the stiffest wall without a limit cycle, against its damping", zwidth},
      Part{"hold", "how still a hard wall is held", hold},
#ifdef REPEL_TELEPRESENCE_ARM
      Part{"contact", "the PUMA driven into a table at various angles", contact},
      Part{"align", "a tilted tool pushed flat against a plate and into a corner", align},
      Part{"relief", "the PUMA made compliant in chosen directions", relief},
      Part{"limits", "a joint of the PUMA at its end, and the operator goes on", joint_limits},
      Part{"friction", "the PUMA against the dry friction of its joints", friction},
      Part{"reflection", "what a line brings back, with and without KBB2", reflection},
#endif
  };
  return all;
}

}  // namespace repel::telepresence
