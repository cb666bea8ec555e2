// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Index types that cannot be mixed up.
#pragma once

#include <cstdint>

namespace repel {

/// An index with its own type: a BodyId does not convert to a PartId.
template <class Tag>
struct Id {
  std::int32_t index = -1;  ///< in the order of addition; -1: of nothing

  /// It names something; whether that exists only its world knows.
  [[nodiscard]] bool valid() const noexcept { return index >= 0; }
  /// The same index.
  friend bool operator==(Id, Id) noexcept = default;
};

using BodyId = Id<struct BodyTag>;  ///< of a body of a World
using PartId = Id<struct PartTag>;  ///< of a part of a body
using PairId = Id<struct PairTag>;  ///< of a pair of parts

}  // namespace repel
