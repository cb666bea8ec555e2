// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The module kinds that a scene file can name: those of the library, and those of a program.
#pragma once

#include <any>
#include <functional>
#include <initializer_list>
#include <map>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include <repel/network/module.hpp>
#include <repel/world/arm.hpp>

namespace repel::scene {

class Map;

/// A spring, damper or mass between a junction and the ground.
struct Element {
  /// What it is.
  enum class Kind { spring, damper, mass };
  Kind kind = Kind::damper;                     ///< which of the three
  network::Space space = network::Space::tool;  ///< tool or lever
  double linear = 0.0;                          ///< [N/m], [N s/m] or [kg]; for a tool only
  double angular = 0.0;                         ///< [N m/rad], [N m s/rad] or [kg m^2]
};

/// One entry of `network`, for the function that reads its module. A key that the function does not
/// read is refused. All functions throw SetupError, naming file, line, value and what is allowed,
/// if a value is invalid.
class ModuleEntry {
 public:
  /// Of this entry of the file, which must outlive it.
  explicit ModuleEntry(const Map& map) : map_(map) {}

  /// The number under `key` in the SI unit `unit`, for example "N s/m"; the file may use another
  /// unit of the same dimension. `otherwise` if the key is missing.
  [[nodiscard]] double number(std::string_view key, std::string_view unit, double low, double high,
                              double otherwise) const;
  /// One of `words`; the first of them if the key is missing.
  [[nodiscard]] std::string word(std::string_view key,
                                 std::initializer_list<std::string_view> words) const;

  /// @throws SetupError for a key that has not been read
  void finish() const;
  /// The complete entry, for the readers of this library, which check the keys themselves.
  [[nodiscard]] const Map& map() const noexcept { return map_; }

 private:
  const Map& map_;
  mutable std::vector<std::string> asked_;
};

/// Makes the module for an arm.
///
/// @throws SetupError if options are out of range
using MakeModule = std::function<network::Module(const ArmModel&)>;

/// A module as read from a file: its options and its factory.
struct ReadModule {
  std::any options;                             ///< of the type that its constructor takes
  MakeModule make;                              ///< makes it when the arm is known
  network::Walls walls = network::Walls::none;  ///< that it applies to the arm, as in its traits
};

/// The kinds of module by the word after `module:`. Initially those of scenes/README.md; a program
/// can add its own:
///
///     scene::ModuleKinds kinds;
///     kinds.add("notch", [](const scene::ModuleEntry& entry) {
///       return Notch(entry.number("frequency", "Hz", 0.1, 100.0, 8.0));
///     });
///     const scene::Scene scene = scene::load("mine.yaml", kinds);
class ModuleKinds {
 public:
  using Read = std::function<ReadModule(const ModuleEntry&)>;  ///< reads the options of one kind

  ModuleKinds();

  /// @param read returns the module itself, or a ReadModule if it depends on the arm
  /// @throws SetupError if the word is already in use
  template <class Function>
  void add(const std::string& word, Function read) {
    insert(word, [read = std::move(read)](const ModuleEntry& entry) {
      const auto result = read(entry);
      entry.finish();
      if constexpr (std::is_same_v<std::remove_cv_t<decltype(result)>, ReadModule>) {
        return result;
      } else {
        const network::Module module(result);
        return ReadModule{{},
                          [module](const ArmModel& /*arm*/) { return network::Module(module); },
                          module->traits().walls};
      }
    });
  }

  /// The words, in the order in which they were added.
  [[nodiscard]] const std::vector<std::string>& words() const noexcept { return words_; }
  /// The reader for a word, which must be one of `words()`.
  [[nodiscard]] const Read& at(const std::string& word) const { return kinds_.at(word); }

 private:
  void insert(const std::string& word, Read read);

  std::vector<std::string> words_;
  std::map<std::string, Read> kinds_;
};

}  // namespace repel::scene
