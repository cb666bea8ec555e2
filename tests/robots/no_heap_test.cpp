// SPDX-License-Identifier: BSD-3-Clause
// Counts every malloc of this program, including those in Eigen.
#include <gtest/gtest.h>

#include <atomic>

#include "arms.hpp"

namespace {
std::atomic<long> allocations{0};
}

// A sanitizer has its own malloc; the test below is then skipped.
#ifndef REPEL_SANITIZED
extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);

void* malloc(std::size_t size) {
  ++allocations;
  return __libc_malloc(size);
}
void* realloc(void* old, std::size_t size) {
  ++allocations;
  return __libc_realloc(old, size);
}
void* calloc(std::size_t count, std::size_t size) {
  ++allocations;
  return __libc_calloc(count, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  ++allocations;
  return __libc_memalign(alignment, size);
}
}
#endif

namespace repel {
namespace no_heap_test {

TEST(NoHeap, UpdateJacobianGravityAndInertiaDoNotAllocate) {
#ifdef REPEL_SANITIZED
  GTEST_SKIP() << "a sanitizer owns malloc";
#endif
  constexpr unsigned seed = 7;
  for (const ArmModel& arm : test::all_arms()) {
    SCOPED_TRACE(arm.name + ", seed " + std::to_string(seed));
    std::mt19937_64 random(seed);
    Kinematics kinematics(arm);
    Eigen::Matrix<double, 6, Eigen::Dynamic> J(6, kinematics.links());
    Eigen::MatrixXd M(kinematics.links(), kinematics.links());
    std::vector<double> torques(arm.links.size());
    for (int sample = 0; sample < 100; ++sample) {
      const auto q = test::random_joints(arm, random);
      const long before = allocations;
      kinematics.update(q);
      kinematics.tool_jacobian(J);
      kinematics.jacobian(0, Vec3::Zero(), J);
      kinematics.gravity_torques(torques);
      ASSERT_TRUE(kinematics.mass_matrix(M));
      ASSERT_EQ(allocations - before, 0);
    }
  }
}

TEST(NoHeap, TheCounterSeesAnAllocation) {
#ifdef REPEL_SANITIZED
  GTEST_SKIP() << "a sanitizer owns malloc";
#endif
  const long before = allocations;
  Eigen::VectorXd v(1000);
  v.setZero();
  EXPECT_GT(allocations - before, 0) << v.sum();
}

}  // namespace no_heap_test
}  // namespace repel
