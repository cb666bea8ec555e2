// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Conversions between what Python passes and the types of the library. Each names what it refuses.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/string.h>

#include <repel/base/spatial.hpp>
#include <repel/base/types.hpp>

namespace repel::python {

namespace nb = nanobind;

/// Numbers of any shape, in the order of C.
using Array = nb::ndarray<const double, nb::numpy, nb::c_contig, nb::device::cpu>;

/// `value` as numbers. @param name of the argument @param expected what it must be, for the error
/// @throws nanobind::type_error naming both
[[nodiscard]] Array array_of(nb::handle value, const char* name, const char* expected);

/// @throws nanobind::value_error: "NAME: expected EXPECTED, got an array of shape (...)"
[[noreturn]] void refuse_shape(const Array& found, const char* name, const char* expected);

/// @throws nanobind::type_error: "NAME: expected EXPECTED, got TYPE"
[[noreturn]] void refuse_type(nb::handle found, const std::string& name, const char* expected);

/// `value` as a number, a word or a list of such; as a pointer, what a class of this module holds.
/// @throws nanobind::type_error naming both
template <class Type>
[[nodiscard]] Type value_of(nb::handle value, const std::string& name, const char* expected) {
  Type made{};
  if (value.is_none() || !nb::try_cast(value, made)) refuse_type(value, name, expected);
  return made;
}

/// The type of what `pose_of` takes, for signatures.
inline const std::string pose_type =
    "numpy.typing.ArrayLike | tuple[numpy.typing.ArrayLike, numpy.typing.ArrayLike]";

/// A rigid pose [m]: 4 x 4 numbers, or a pair of position (3,) and unit quaternion w, x, y, z (4,).
/// @throws SetupError for numbers that are not finite or not rigid
[[nodiscard]] Pose pose_of(nb::handle value, const char* name);
/// The same of N: (N, 4, 4), or a pair of (N, 3) and (N, 4).
/// @param of_batch rows of each batch, for errors; 0: there are no batches
[[nodiscard]] std::vector<Pose> poses_of(nb::handle value, const char* name,
                                         std::size_t of_batch = 0);

/// Three numbers, finite.
[[nodiscard]] Vec3 vector_of(nb::handle value, const char* name);
/// N times three numbers.
[[nodiscard]] std::vector<Vec3> points_of(nb::handle value, const char* name);
/// N numbers. They may be NaN: readings of an arm may. @param joints how many there must be
/// @throws nanobind::value_error naming both numbers
[[nodiscard]] std::vector<double> numbers_of(nb::handle value, const char* name,
                                             std::optional<std::size_t> joints = {});
/// Six numbers, linear then angular; they may be NaN.
[[nodiscard]] Twist twist_of(nb::handle value, const char* name);

/// A new array of Python's own.
[[nodiscard]] nb::object to_array(const double* values, std::initializer_list<std::size_t> shape);
[[nodiscard]] nb::object to_array(const Vec3& v);
[[nodiscard]] nb::object to_array(const std::vector<Vec3>& points);
/// 4 x 4
[[nodiscard]] nb::object to_array(const Pose& X);
/// (6,): force, torque
[[nodiscard]] nb::object to_array(const Wrench& F);
/// (6,): linear, angular
[[nodiscard]] nb::object to_array(const Twist& V);

}  // namespace repel::python
