// SPDX-License-Identifier: BSD-3-Clause
#include <repel/common/complaint.hpp>

#include <gtest/gtest.h>

#include <new>
#include <stdexcept>

namespace repel {
namespace complaint_test {

TEST(Complaint, IsEmptyWhenNothingIsThrown) {
  bool done = false;
  EXPECT_EQ(complaint_of([&] { done = true; }), "");
  EXPECT_TRUE(done);
}

TEST(Complaint, IsWhatTheExceptionSays) {
  EXPECT_EQ(complaint_of([] { throw std::runtime_error("no room"); }), "no room");
  EXPECT_NE(complaint_of([] { throw std::bad_alloc(); }), "");
}

TEST(Complaint, IsNeverEmptyWhenSomethingIsThrown) {
  EXPECT_EQ(complaint_of([] { throw std::runtime_error(""); }), "unknown");
  EXPECT_EQ(complaint_of([] { throw 1; }), "unknown");
}

}  // namespace complaint_test
}  // namespace repel
