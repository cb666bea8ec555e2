// SPDX-License-Identifier: BSD-3-Clause
#include <repel/schedule/supervisor.hpp>

#include <cstdint>

namespace repel::detail {

bool Watch::is_overdue(std::uint64_t value) noexcept {
  stood_ = value == last_ ? stood_ + 1 : 0;
  last_ = value;
  return stood_ == limit;
}

}  // namespace repel::detail
