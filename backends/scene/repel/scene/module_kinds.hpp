/// @file
/// The modules that a scene file can name: those of the library, and those of a program.
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
  enum class Kind { spring, damper, mass };
  Kind kind = Kind::damper;
  network::Space space = network::Space::tool;  ///< tool or lever
  double linear = 0.0;                          ///< [N/m], [N s/m] or [kg]; of a tool
  double angular = 0.0;                         ///< [N m/rad], [N m s/rad] or [kg m^2]
};

/// What one entry of `network` says, for the function that reads its module. A key that is not
/// asked for is refused. Its functions throw SetupError, naming file, line, value and what is
/// allowed, when a value is not what is asked for.
class ModuleEntry {
 public:
  explicit ModuleEntry(const Map& map) : map_(map) {}

  /// The number under `key` in the SI unit `unit`, "N s/m" say; the file may use another unit of
  /// the same dimension. `otherwise` when the key is missing.
  [[nodiscard]] double number(std::string_view key, std::string_view unit, double low, double high,
                              double otherwise) const;
  /// One of `words`; the first of them when the key is missing.
  [[nodiscard]] std::string word(std::string_view key,
                                 std::initializer_list<std::string_view> words) const;

  /// Throws SetupError for a key that has not been asked for.
  void finish() const;
  /// All that the file says, for the readers of this library, which check the keys themselves.
  [[nodiscard]] const Map& map() const noexcept { return map_; }

 private:
  const Map& map_;
  mutable std::vector<std::string> asked_;
};

/// Makes the module for an arm. @throws SetupError for options out of range
using MakeModule = std::function<network::Module(const ArmModel&)>;

/// One module as read: what it was given and how it is made.
struct ReadModule {
  std::any options;  ///< of the type that its constructor takes
  MakeModule make;
  network::Walls walls = network::Walls::none;  ///< that it brings to the arm, as its traits say
};

/// The kinds of module by the word after `module:`. It begins with those of scenes/README.md; a
/// program adds its own:
///
///     scene::ModuleKinds kinds;
///     kinds.add("notch", [](const scene::ModuleEntry& entry) {
///       return Notch(entry.number("frequency", "Hz", 0.1, 100.0, 8.0));
///     });
///     const scene::Scene scene = scene::load("mine.yaml", kinds);
class ModuleKinds {
 public:
  using Read = std::function<ReadModule(const ModuleEntry&)>;

  ModuleKinds();

  /// @param read the module itself, or a ReadModule where it depends on the arm
  /// @throws SetupError when there is such a word already
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
  /// How the module of a word is read, which must be one of `words()`.
  [[nodiscard]] const Read& at(const std::string& word) const { return kinds_.at(word); }

 private:
  void insert(const std::string& word, Read read);

  std::vector<std::string> words_;
  std::map<std::string, Read> kinds_;
};

}  // namespace repel::scene
