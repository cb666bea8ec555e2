// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/machinery/optional_functions.hpp>

#include <gtest/gtest.h>

#include <repel/network/modules.hpp>

namespace repel::network {
namespace optional_functions_test {

// What the compiler refuses is in tests/network/missing_function.

struct None {};
struct Data {
  int read = 0;
};
struct Overloaded {
  void read(int);
  void read(double);
};
struct Template {
  template <class T>
  void read(T);
};
class Private {
  void read();
};
struct Heir : Overloaded {};
struct Last final {
  void read(int);
};
static_assert(!detail::has_read<None>() && !detail::has_predict<Last>());
static_assert(detail::has_read<Data>() && detail::has_read<Overloaded>() &&
              detail::has_read<Template>() && detail::has_read<Private>() &&
              detail::has_read<Heir>() && detail::has_read<Last>());

/// What is declared in other words and can be called all the same.
struct InOtherWords {
  void read(Signals signals);
  void prepare(float period);
  long size() const;
  template <class Numbers>
  void add_walls(const Jacobian& jacobian, Numbers& torques) const;
  static constexpr Traits traits{};
};
static_assert(detail::Reads<InOtherWords> && detail::Prepares<InOtherWords> &&
              detail::KnowsItsSize<InOtherWords> && detail::AddsWalls<InOtherWords> &&
              detail::HasTraits<InOtherWords>);

TEST(OptionalFunctions, AreThoseThatTheModulesOfTheLibraryHave) {
  detail::require_callable<InOtherWords>();
  EXPECT_TRUE(detail::AddsWalls<ArmObstacle>);
  EXPECT_TRUE(detail::AddsWallDamping<Limits> || detail::AddsWalls<Limits>);
  EXPECT_TRUE(detail::Suits<Relief> || detail::Suits<Kbb2>);
  EXPECT_TRUE(detail::Supplies<TorqueArm>);
  EXPECT_TRUE(detail::Saturates<Kbb2>);
  EXPECT_FALSE(detail::Predicts<Kbb2>);
}

}  // namespace optional_functions_test
}  // namespace repel::network
