// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// ABI settings shared by a program and the linked parts of this library.
///
/// Flags like -mavx change the alignment of the types of Eigen, and with it the layout of types
/// that hold them; and how functions take vectors of this library. So each compiled part defines a
/// function `is_built_for` for its own flags, and its headers refer to the one for the flags in
/// use: a program compiled with other flags fails to link, instead of failing at run time.
#pragma once

#include <Eigen/Core>

#include <repel/base/lanes.hpp>

namespace repel {

/// [bytes] Alignment of the types of Eigen, in classes and on the heap.
template <int in_classes, int on_the_heap>
struct EigenAlignment {};
/// [bytes] Size of the registers in which functions take vectors and lanes of this library.
template <int size>
struct VectorRegister {};

/// Those of the translation unit that names them.
using EigenAlignmentHere = EigenAlignment<EIGEN_MAX_STATIC_ALIGN_BYTES, EIGEN_MAX_ALIGN_BYTES>;
/// The registers of the code that includes this header.
using VectorRegisterHere = VectorRegister<detail::register_bytes>;

}  // namespace repel
