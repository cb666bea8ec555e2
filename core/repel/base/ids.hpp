// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Index types that cannot be mixed up.
#pragma once

#include <cstdint>

namespace repel {

/// An index with its own type: a BodyId does not convert to a PartId.
template <class Tag>
struct Id {
  std::int32_t index = -1;

  [[nodiscard]] bool valid() const noexcept { return index >= 0; }
  friend bool operator==(Id, Id) noexcept = default;
};

using BodyId = Id<struct BodyTag>;
using PartId = Id<struct PartTag>;
using PairId = Id<struct PairTag>;

}  // namespace repel
