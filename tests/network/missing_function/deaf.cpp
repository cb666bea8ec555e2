// SPDX-License-Identifier: BSD-3-Clause
// A matched one-port without a function that receives its wave.
#include <repel/network/module.hpp>

using namespace repel::network;

class Deaf {
 public:
  [[nodiscard]] const Mat<1>& resistance() const noexcept { return R_; }
  [[nodiscard]] Vec<1> reflected() const noexcept { return Vec<1>::Zero(); }

 private:
  Mat<1> R_ = Mat<1>::Ones();
};

Module module_of_its_own() {
  return Deaf();
}
