#include <repel/reduction/separations.hpp>

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include <support/families.hpp>

namespace repel {
namespace {

using families::Rng;

constexpr unsigned seed = 2468;

Shape random_shape(Rng& rng) {
  switch (families::count_between(rng, 0, 5)) {
    case 0:
      return Shape::sphere(families::uniform(rng, 0.1, 0.4));
    case 1:
      return Shape::capsule(families::uniform(rng, 0.1, 0.2), 0.3);
    case 2:
      return Shape::cylinder(0.2, families::uniform(rng, 0.1, 0.4));
    case 3:
      return Shape::hull(families::cloud(rng, families::count_between(rng, 4, 60), 0.4).vertices,
                         {.levels = 2});
    default:
      return Shape::box({0.2, families::uniform(rng, 0.1, 0.4), 0.3});
  }
}

/// A shape, its partners, and the same queries one by one.
struct Scene {
  Shape A;
  Pose X_WA;
  std::vector<Shape> B;
  std::vector<Pose> X_WB;
  std::vector<WarmStart> warm, warm_of_one;
  std::vector<Separation> answers;
  std::vector<Partner> partners;

  Scene(Rng& rng, int count) : A(random_shape(rng)), X_WA(families::random_pose(rng, 0.1, 1.0)) {
    for (int i = 0; i < count; ++i) {
      B.push_back(random_shape(rng));
      X_WB.push_back(families::random_pose(rng, 0.1, 2.0));
    }
    warm.resize(B.size());
    warm_of_one.resize(B.size());
    answers.resize(B.size());
    for (std::size_t i = 0; i < B.size(); ++i) {
      partners.push_back({&B[i], &X_WB[i], &warm[i], &answers[i]});
    }
  }
};

void expect_same(const Separation& many, const Separation& one) {
  EXPECT_NEAR(many.distance, one.distance, 1e-13);
  EXPECT_LE(many.lower, one.upper);
  EXPECT_GE(many.upper, one.lower);
  EXPECT_EQ(many.end, one.end);
  EXPECT_EQ(many.level, one.level);
  EXPECT_LE((many.extraction_W - one.extraction_W).norm(), 1e-6);
  EXPECT_NEAR((many.p_WA - many.p_WB).dot(many.extraction_W),
              (one.p_WA - one.p_WB).dot(one.extraction_W), 1e-9);
}

TEST(Separations, AreTheSeparationsOneByOneTickAfterTick) {
  Rng rng(seed);
  int apart = 0, overlapping = 0;
  for (int i = 0; i < 150; ++i) {
    Scene scene(rng, families::count_between(rng, 1, 19));
    for (int tick = 0; tick < 6; ++tick) {
      separations(scene.A, scene.X_WA, scene.partners);
      for (std::size_t k = 0; k < scene.B.size(); ++k) {
        SCOPED_TRACE(families::of_seed(seed, "scene", i) + ", tick " + std::to_string(tick) +
                     ", partner " + std::to_string(k));
        const Separation one =
            separation(scene.A, scene.X_WA, scene.B[k], scene.X_WB[k], {}, scene.warm_of_one[k]);
        expect_same(scene.answers[k], one);
        ++(one.distance > 0.0 ? apart : overlapping);
      }
      scene.X_WA.translation() += 1e-3 * families::direction(rng);
      scene.X_WA.linear() = families::small_rotation(rng, 2e-3) * scene.X_WA.linear();
    }
  }
  EXPECT_GT(apart, 3000);
  EXPECT_GT(overlapping, 1000);
}

TEST(Separations, OptionsThatMakeNoSenseClaimNothing) {
  Rng rng(seed);
  Scene scene(rng, 9);
  separations(scene.A, scene.X_WA, scene.partners);
  separations(scene.A, scene.X_WA, scene.partners, {.iterations = 0});
  for (const Separation& s : scene.answers) EXPECT_EQ(s.end, QueryEnd::bad_input);
}

TEST(Separations, APoseThatIsNotFiniteHarmsNoOtherPartner) {
  Rng rng(seed);
  Scene scene(rng, 12);
  separations(scene.A, scene.X_WA, scene.partners);
  const std::vector<Separation> before = scene.answers;
  scene.X_WB[5].translation().y() = std::numeric_limits<double>::quiet_NaN();
  separations(scene.A, scene.X_WA, scene.partners);
  for (std::size_t k = 0; k < scene.B.size(); ++k) {
    if (k == 5) {
      EXPECT_EQ(scene.answers[k].end, QueryEnd::bad_input);
    } else {
      EXPECT_NEAR(scene.answers[k].distance, before[k].distance, 1e-13) << k;
    }
  }
}

}  // namespace
}  // namespace repel
