#include <repel/schedule/contacts.hpp>

#include <gtest/gtest.h>

#include "schedule/boxes.hpp"

namespace repel::detail {
namespace contacts_test {

constexpr unsigned seed = 6011;
constexpr int most = 19;

WarmStart some_feature() {
  WarmStart warm;
  warm.size = 1;
  return warm;
}

/// Contacts, and the slots that should be on their seats; a slot is the number of its pair.
struct Seated {
  test::Crowd crowd{seed};
  PartPoses poses{crowd.world};
  Contacts contacts{most};
  std::vector<std::int32_t> model;

  [[nodiscard]] const Pair& pair(std::int32_t slot) const { return crowd.world.pair({slot}); }
  void add(std::int32_t slot) {
    const int seat = contacts.add(slot, crowd.world, pair(slot), some_feature(), poses);
    ASSERT_EQ(seat, static_cast<int>(model.size()));
    model.push_back(slot);
  }
  void remove(int seat) {
    contacts.replace_by_last(seat, crowd.world, pair(model.back()), some_feature(), poses);
    model[static_cast<std::size_t>(seat)] = model.back();
    model.pop_back();
  }
  void expect_as_modelled() const {
    const int count = static_cast<int>(model.size());
    ASSERT_EQ(contacts.count(), count);
    ASSERT_EQ(contacts.groups(), (count + lane_count - 1) / lane_count);
    int used = 0;
    for (int g = 0; g < contacts.groups(); ++g) {
      const unsigned taken = (1U << contacts.taken(g)) - 1U;
      ASSERT_EQ(contacts.group(g).used(), taken) << "group " << g;
      used += contacts.taken(g);
    }
    ASSERT_EQ(used, count);
    for (int seat = 0; seat < count; ++seat) {
      const std::int32_t slot = model[static_cast<std::size_t>(seat)];
      const ContactGroup& group = contacts.group(Contacts::group_of(seat));
      const int k = Contacts::lane_of(seat);
      ASSERT_EQ(contacts.slot(seat), slot);
      ASSERT_EQ(group.body_a(k), crowd.world.part(pair(slot).a).body);
      ASSERT_EQ(group.body_b(k), crowd.world.part(pair(slot).b).body);
    }
  }
};

TEST(Contacts, HaveNoGapsWhoeverComesAndGoes) {
  Seated seated;
  int full = 0, empty = 0;
  const int pairs = static_cast<int>(seated.crowd.world.pairs().size());
  families::Rng random(seed);
  for (int step = 0; step < 4000; ++step) {
    SCOPED_TRACE(families::of_seed(seed, "step", step));
    const int count = seated.contacts.count();
    // More come than go for a while, then more go than come.
    const bool comes = families::count_between(random, 0, 9) < (step / 100 % 2 == 0 ? 7 : 3);
    if (comes && count < most) seated.add(families::count_between(random, 0, pairs - 1));
    if (!comes && count > 0) seated.remove(families::count_between(random, 0, count - 1));
    seated.expect_as_modelled();
    if (HasFailure()) return;
    full += count == most ? 1 : 0;
    empty += count == 0 ? 1 : 0;
  }
  EXPECT_GT(full, 100) << "seed " << seed;
  EXPECT_GT(empty, 100) << "seed " << seed;
}

TEST(Contacts, GrowOldAltogether) {
  Seated seated;
  for (std::int32_t slot = 0; slot < most; ++slot) seated.add(slot);
  Contacts& contacts = seated.contacts;
  for (int g = 0; g < contacts.groups(); ++g) {
    contacts.group(g).evaluate(seated.crowd.world.motion(), seated.poses);
    EXPECT_TRUE(contacts.group(g).fresh());
  }
  contacts.grow_old();
  for (int g = 0; g < contacts.groups(); ++g) EXPECT_FALSE(contacts.group(g).fresh());
}

}  // namespace contacts_test
}  // namespace repel::detail
