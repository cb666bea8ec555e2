// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Makes a mesh that is only looked at smaller.
#pragma once

#include <cstddef>

#include <repel/geometry/triangle_mesh.hpp>

namespace repel::detail {

/// `mesh` with at most `most` triangles: vertices in one cell of a grid become the first of them,
/// and triangles that lose their area go. The grid is as fine as it can be in steps of a factor of
/// 1.5, from 1/512 of the extent on. A mesh that is small enough stays as it is.
[[nodiscard]] TriangleMesh thinned(TriangleMesh mesh, std::size_t most);

}  // namespace repel::detail
