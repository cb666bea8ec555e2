// SPDX-License-Identifier: BSD-3-Clause
#include "arrays.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include <repel/base/setup_error.hpp>

#include "interpreter.hpp"

namespace repel::python {
namespace {

constexpr const char* one_pose = "a 4x4 rigid pose, or (position (3,), quaternion w x y z (4,))";
constexpr const char* many_poses =
    "N rigid poses (N, 4, 4), or (positions (N, 3), quaternions w x y z (N, 4))";

bool has_shape(const Array& array, std::initializer_list<std::int64_t> shape) {
  if (array.ndim() != shape.size()) return false;
  std::size_t axis = 0;
  for (const std::int64_t size : shape) {
    if (size >= 0 && array.shape(axis) != static_cast<std::size_t>(size)) return false;
    ++axis;
  }
  return true;
}

/// Of an argument.
struct Row {
  std::size_t number = 0;
  std::size_t of_batch = 0;  ///< rows of each batch; 0: there are no batches
};

/// The name of an argument, or of one row of it: X_W[3], in batches X_W[1, 0].
std::string named(const char* name, std::optional<Row> row) {
  std::string text(name);
  if (!row) return text;
  text += '[';
  if (row->of_batch > 0) text += std::to_string(row->number / row->of_batch) + ", ";
  text += std::to_string(row->of_batch > 0 ? row->number % row->of_batch : row->number);
  return text + ']';
}

/// @throws SetupError unless `X` can be used
const Pose& required(const Pose& X, const char* name, std::optional<Row> row) {
  if (!is_finite(X)) throw SetupError(named(name, row) + ": an entry is not finite");
  if (!is_rigid(X)) {
    throw SetupError(named(name, row) +
                     ": the rotation is not orthonormal to 1e-9 and right-handed; allowed: a rigid "
                     "pose");
  }
  return X;
}

Pose pose_from_matrix(const double* rows, const char* name, std::optional<Row> row) {
  Pose X;
  for (int i = 0; i < 4; ++i) {
    for (int k = 0; k < 4; ++k) X.matrix()(i, k) = rows[4 * i + k];
  }
  if (!is_finite(X)) throw SetupError(named(name, row) + ": an entry is not finite");
  const double* last = rows + 12;
  if (last[0] != 0.0 || last[1] != 0.0 || last[2] != 0.0 || last[3] != 1.0) {
    throw SetupError(named(name, row) + ": the last row of a pose is not 0 0 0 1");
  }
  return required(X, name, row);
}

Pose pose_from_quaternion(const double* p, const double* q, const char* name,
                          std::optional<Row> row) {
  const Eigen::Quaterniond turn(q[0], q[1], q[2], q[3]);
  const double length = turn.norm();
  if (!(std::abs(length - 1.0) <= 1e-6)) {
    throw SetupError(named(name, row) + ": the quaternion has length " + to_text(length, 6) +
                     "; allowed: 0.999999 to 1.000001");
  }
  Pose X = Pose::Identity();
  X.linear() = turn.normalized().toRotationMatrix();
  X.translation() = Vec3(p[0], p[1], p[2]);
  return required(X, name, row);
}

bool is_pair(nb::handle value) {
  return (nb::isinstance<nb::tuple>(value) || nb::isinstance<nb::list>(value)) &&
         nb::len(value) == 2;
}

}  // namespace

void refuse_shape(const Array& found, const char* name, const char* expected) {
  std::string text(name);
  text.append(": expected ").append(expected).append(", got an array of shape (");
  for (std::size_t i = 0; i < found.ndim(); ++i) {
    text.append(i > 0 ? ", " : "").append(std::to_string(found.shape(i)));
  }
  text.append(found.ndim() == 1 ? ",)" : ")");
  throw nb::value_error(text.c_str());
}

void refuse_type(nb::handle found, const std::string& name, const char* expected) {
  const std::string type = nb::cast<std::string>(nb::handle(found.type()).attr("__name__"));
  throw nb::type_error((name + ": expected " + expected + ", got " + type).c_str());
}

Array array_of(nb::handle value, const char* name, const char* expected) {
  Array array;
  // Kept for the process: to look it up takes as long as the rest.
  static const nb::handle ndarray =
      nb::object(nb::module_::import_("numpy").attr("ndarray")).release();
  // All else, NumPy reads: nanobind crashes on some of what has a buffer, as a datetime64.
  if (value.type().is(ndarray) && nb::try_cast(value, array, false)) return array;
  std::string type = nb::cast<std::string>(nb::handle(value.type()).attr("__name__"));
  try {
    const nb::module_ numpy = nb::module_::import_("numpy");
    const nb::object found = call_method(numpy, "asarray", value);
    const std::string kind = nb::cast<std::string>(found.attr("dtype").attr("kind"));
    if (kind == "f" || kind == "i" || kind == "u") {
      return nb::cast<Array>(call_method(numpy, "ascontiguousarray", found, numpy.attr("float64")));
    }
    type += " of " + nb::cast<std::string>(found.attr("dtype").attr("name"));
  } catch (const nb::python_error&) {
    type += " that is no array";
  }
  throw nb::type_error((std::string(name) + ": expected " + expected + ", got " + type).c_str());
}

Pose pose_of(nb::handle value, const char* name) {
  if (!is_pair(value)) {
    const Array X = array_of(value, name, one_pose);
    if (!has_shape(X, {4, 4})) refuse_shape(X, name, one_pose);
    return pose_from_matrix(X.data(), name, {});
  }
  const Array p = array_of(value[0], name, one_pose);
  const Array q = array_of(value[1], name, one_pose);
  if (!has_shape(p, {3})) refuse_shape(p, name, one_pose);
  if (!has_shape(q, {4})) refuse_shape(q, name, one_pose);
  return pose_from_quaternion(p.data(), q.data(), name, {});
}

std::vector<Pose> poses_of(nb::handle value, const char* name, std::size_t of_batch) {
  std::vector<Pose> poses;
  if (!is_pair(value)) {
    const Array X = array_of(value, name, many_poses);
    if (!has_shape(X, {-1, 4, 4})) refuse_shape(X, name, many_poses);
    poses.reserve(X.shape(0));
    for (std::size_t i = 0; i < X.shape(0); ++i) {
      poses.push_back(pose_from_matrix(X.data() + 16 * i, name, Row{i, of_batch}));
    }
    return poses;
  }
  const Array p = array_of(value[0], name, many_poses);
  const Array q = array_of(value[1], name, many_poses);
  if (!has_shape(p, {-1, 3})) refuse_shape(p, name, many_poses);
  if (!has_shape(q, {static_cast<std::int64_t>(p.shape(0)), 4})) {
    refuse_shape(q, name, many_poses);
  }
  poses.reserve(p.shape(0));
  for (std::size_t i = 0; i < p.shape(0); ++i) {
    poses.push_back(pose_from_quaternion(p.data() + 3 * i, q.data() + 4 * i, name, Row{i}));
  }
  return poses;
}

Vec3 vector_of(nb::handle value, const char* name) {
  constexpr const char* expected = "three numbers (3,)";
  const Array v = array_of(value, name, expected);
  if (!has_shape(v, {3})) refuse_shape(v, name, expected);
  Vec3 vector(v.data()[0], v.data()[1], v.data()[2]);
  if (!is_finite(vector)) throw SetupError(named(name, {}) + ": an entry is not finite");
  return vector;
}

std::vector<Vec3> points_of(nb::handle value, const char* name) {
  constexpr const char* expected = "points (N, 3)";
  const Array p = array_of(value, name, expected);
  if (!has_shape(p, {-1, 3})) refuse_shape(p, name, expected);
  std::vector<Vec3> points;
  points.reserve(p.shape(0));
  for (std::size_t i = 0; i < p.shape(0); ++i) {
    const double* at = p.data() + 3 * i;
    points.emplace_back(at[0], at[1], at[2]);
    if (!is_finite(points.back()))
      throw SetupError(named(name, Row{i}) + ": an entry is not finite");
  }
  return points;
}

std::vector<double> numbers_of(nb::handle value, const char* name,
                               std::optional<std::size_t> joints) {
  constexpr const char* expected = "a number for each joint (N,)";
  const Array numbers = array_of(value, name, expected);
  if (!has_shape(numbers, {-1})) refuse_shape(numbers, name, expected);
  if (joints && numbers.size() != *joints) {
    throw nb::value_error((std::string(name) + ": expected " + std::to_string(*joints) +
                           " numbers, one for each joint, got " + std::to_string(numbers.size()))
                              .c_str());
  }
  return {numbers.data(), numbers.data() + numbers.size()};
}

Twist twist_of(nb::handle value, const char* name) {
  constexpr const char* expected = "six numbers (6,), linear then angular";
  const Array V = array_of(value, name, expected);
  if (!has_shape(V, {6})) refuse_shape(V, name, expected);
  const double* v = V.data();
  return {{v[0], v[1], v[2]}, {v[3], v[4], v[5]}};
}

nb::object to_array(const double* values, std::initializer_list<std::size_t> shape) {
  std::size_t size = 1;
  for (const std::size_t length : shape) size *= length;
  auto own = std::make_unique<double[]>(size);
  std::copy(values, values + size, own.get());
  double* data = own.get();
  const nb::capsule owner(own.release(),
                          [](void* p) noexcept { delete[] static_cast<double*>(p); });
  return nb::cast(nb::ndarray<nb::numpy, double>(data, shape.size(), shape.begin(), owner));
}

nb::object to_array(const Vec3& v) {
  return to_array(v.data(), {3});
}

nb::object to_array(const std::vector<Vec3>& points) {
  std::vector<double> numbers;
  numbers.reserve(3 * points.size());
  for (const Vec3& p : points) numbers.insert(numbers.end(), p.data(), p.data() + 3);
  return to_array(numbers.data(), {points.size(), 3});
}

nb::object to_array(const Pose& X) {
  std::array<double, 16> rows{};
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t k = 0; k < 4; ++k) rows[4 * i + k] = X.matrix().data()[4 * k + i];
  }
  return to_array(rows.data(), {4, 4});
}

nb::object to_array(const Wrench& F) {
  const std::array<double, 6> six{F.force[0],  F.force[1],  F.force[2],
                                  F.torque[0], F.torque[1], F.torque[2]};
  return to_array(six.data(), {6});
}

nb::object to_array(const Twist& V) {
  return to_array(Wrench{V.linear, V.angular});
}

}  // namespace repel::python
