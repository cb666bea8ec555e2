/// @file
/// What a program must have in common with the compiled parts of this library that it links.
///
/// Flags like -mavx change how types lie in memory. So each compiled part defines a function
/// `is_built_for` for its own flags, and its headers refer to that of theirs: a program that is
/// compiled with others does not link, instead of failing where the two meet.
#pragma once

#include <Eigen/Core>

#include <repel/base/lanes.hpp>

namespace repel {

/// [bytes] To what Eigen aligns its types, in classes and on the heap.
template <int in_classes, int on_the_heap>
struct EigenAlignment {};
/// [bytes] The register that vectors and lanes of this library are laid out for.
template <int size>
struct VectorRegister {};

/// Of the translation unit that names them.
using EigenAlignmentHere = EigenAlignment<EIGEN_MAX_STATIC_ALIGN_BYTES, EIGEN_MAX_ALIGN_BYTES>;
using VectorRegisterHere = VectorRegister<detail::lane_bytes>;

}  // namespace repel
