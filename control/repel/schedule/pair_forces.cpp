// SPDX-License-Identifier: BSD-3-Clause
#include <repel/schedule/pair_forces.hpp>

namespace repel {

void WorkerReport::count(bool late) noexcept {
  stood_in = late ? 1 : 0;
  silence = late ? silence + 1 : 0;
  ticks += stood_in;
  longest_silence = silence > longest_silence ? silence : longest_silence;
  oldest_age = age > oldest_age ? age : oldest_age;
}

}  // namespace repel
