// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Values as bytes, handed back by a child process.
#pragma once

#include <cstddef>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include <repel/base/setup_error.hpp>

namespace repel::detail {

/// Puts values one behind the other, each list behind its length.
class Parcel {
 public:
  template <class T>
  void put(const T& value) {
    static_assert(std::is_trivially_destructible_v<T>);
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  template <class T>
  void put_list(const T& values) {
    put(values.size());
    bytes_.append(reinterpret_cast<const char*>(values.data()),
                  values.size() * sizeof *values.data());
  }
  /// All of it.
  [[nodiscard]] std::string take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

/// Takes them out again, in the same order. A corrupted child may have put anything: no length is
/// trusted, and the caller must check the values.
class Unpacking {
 public:
  /// @param bytes must outlive this object
  explicit Unpacking(std::string_view bytes) : bytes_(bytes) {}

  /// @throws SetupError if there are too few bytes
  template <class T>
  [[nodiscard]] T take() {
    T value{};
    std::memcpy(static_cast<void*>(&value), next(sizeof value), sizeof value);
    return value;
  }
  /// A std::string or std::vector. @throws SetupError if there are too few bytes
  template <class T>
  [[nodiscard]] T take_list() {
    using Value = typename T::value_type;
    const auto count = take<std::size_t>();
    if (count > bytes_.size() / sizeof(Value)) fail();
    T values;
    values.resize(count);
    if (count > 0) {
      std::memcpy(static_cast<void*>(values.data()), next(count * sizeof(Value)),
                  count * sizeof(Value));
    }
    return values;
  }

 private:
  [[noreturn]] static void fail() { throw SetupError("cannot be read: its reader was disturbed"); }

  const char* next(std::size_t count) {
    if (count > bytes_.size()) fail();
    const char* const begin = bytes_.data();
    bytes_.remove_prefix(count);
    return begin;
  }

  std::string_view bytes_;
};

}  // namespace repel::detail
