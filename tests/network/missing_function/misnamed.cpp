// SPDX-License-Identifier: BSD-3-Clause
// A one-port whose optional functions would never be called: each has a signature of its own.
#include <repel/network/module.hpp>

using namespace repel::network;

class Misnamed {
 public:
  void equivalent(Equivalent<any_size>&) const noexcept {}
  int traits = 0;
  void fit(int) {}
  int size() noexcept { return 6; }  // not const
  void face() noexcept {}
  void suit(RobotEnd&) {}
  void prepare() {}
  void read(Signals&) noexcept {}
  double supplied(double) const noexcept { return 0.0; }
  void left_weight() const noexcept {}
  bool saturated(int) const noexcept { return false; }
  bool saturated(double) const noexcept { return false; }
  void add_walls(const Jacobian&, Vec<any_size>&) noexcept {}  // not const
  void add_wall_damping(const Jacobian&) const noexcept {}
  void predict(const Signals&) noexcept {}

 private:
  PassivityReport passivity() const noexcept { return {}; }
};

Module module_of_its_own() {
  return Misnamed();
}
