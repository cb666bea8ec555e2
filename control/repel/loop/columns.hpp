// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The numbers of a tick of one arm in a row, and their names: those of the CSV columns.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include <repel/loop/record.hpp>
#include <repel/world/arm.hpp>

namespace repel {

/// What tells how many numbers an arm has, and how they are called.
struct ColumnNames {
  std::span<const JointType> joints;     ///< base outward
  std::span<const std::string> modules;  ///< of its network, in its order

  /// The columns of a field whose values are of type `Value`; none if it has no column.
  template <class Value>
  [[nodiscard]] std::vector<std::string> of(const TickField& field) const {
    const std::string pattern = field.column;
    std::vector<std::string> names;
    const auto add = [&names](std::string pattern_of, const std::string& name) {
      const std::size_t star = pattern_of.find('*');
      names.push_back(star == std::string::npos ? pattern_of : pattern_of.replace(star, 1, name));
    };
    if (pattern.empty()) return names;
    if constexpr (std::is_same_v<Value, JointNumbers>) {
      const std::size_t blank = pattern.find(' ');
      for (std::size_t i = 0; i < joints.size(); ++i) {
        const bool turns = joints[i] == JointType::revolute;
        add(turns ? pattern.substr(0, blank) : pattern.substr(blank + 1), std::to_string(i + 1));
      }
    } else if constexpr (std::is_same_v<Value, ModuleEnergies>) {
      for (const std::string& module : modules) add(pattern, module);
    } else if constexpr (std::is_same_v<Value, Vec3>) {
      for (const char* axis : {"x", "y", "z"}) add(pattern, axis);
    } else {
      add(pattern, {});
    }
    return names;
  }
};

/// Calls visit(x) for each value of a tick that has a column, in the order of the columns.
template <class Visit>
void for_each_value(const TickRecord& record, std::size_t joints, std::size_t modules,
                    const Visit& visit) {
  for_each_field(
      [&](const TickField& field, const auto& x) {
        using Value = std::remove_cvref_t<decltype(x)>;
        if (*field.column == '\0') return;
        const auto visit_first = [&visit](const auto& all, std::size_t count) {
          for (std::size_t i = 0; i < count; ++i) visit(all[i]);
        };
        if constexpr (std::is_same_v<Value, JointNumbers>) {
          visit_first(x, joints);
        } else if constexpr (std::is_same_v<Value, ModuleEnergies>) {
          visit_first(x, modules);
        } else if constexpr (std::is_same_v<Value, Vec3>) {
          visit_first(x, 3);
        } else if constexpr (!std::is_same_v<Value, Wrench>) {
          visit(x);
        }
      },
      record);
}

}  // namespace repel
