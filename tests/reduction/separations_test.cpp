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

/// Pairs of shapes, and what asking them together and one by one has left.
struct Scene {
  std::vector<Shape> A, B;
  std::vector<Pose> X_WA, X_WB;
  std::vector<WarmStart> warm, warm_of_one;
  std::vector<Separation> answers;
  std::vector<SeparationQuery> queries;

  Scene(Rng& rng, int count) {
    for (int i = 0; i < count; ++i) {
      A.push_back(random_shape(rng));
      B.push_back(random_shape(rng));
      X_WA.push_back(families::random_pose(rng, 0.1, 1.0));
      X_WB.push_back(families::random_pose(rng, 0.1, 2.0));
    }
    warm.resize(B.size());
    warm_of_one.resize(B.size());
    answers.resize(B.size());
    for (std::size_t i = 0; i < B.size(); ++i) {
      queries.push_back({&A[i], &X_WA[i], &B[i], &X_WB[i], &warm[i], &answers[i]});
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
      separations(scene.queries);
      for (std::size_t k = 0; k < scene.B.size(); ++k) {
        SCOPED_TRACE(families::of_seed(seed, "scene", i) + ", tick " + std::to_string(tick) +
                     ", pair " + std::to_string(k));
        const Separation one = separation(scene.A[k], scene.X_WA[k], scene.B[k], scene.X_WB[k], {},
                                          scene.warm_of_one[k]);
        expect_same(scene.answers[k], one);
        ++(one.distance > 0.0 ? apart : overlapping);
      }
      for (Pose& X_WA : scene.X_WA) {
        X_WA.translation() += 1e-3 * families::direction(rng);
        X_WA.linear() = families::small_rotation(rng, 2e-3) * X_WA.linear();
      }
    }
  }
  EXPECT_GT(apart, 3000);
  EXPECT_GT(overlapping, 1000);
}

// What a pair is answered must not depend on which others are near it in the same tick.
TEST(Separations, AnswerIsTheSameBitsWhateverElseIsAsked) {
  Rng rng(seed);
  for (int i = 0; i < 100; ++i) {
    Scene scene(rng, 11);
    separations(scene.queries);
    for (Pose& X_WA : scene.X_WA) X_WA.translation() += 1e-3 * families::direction(rng);
    const std::vector<WarmStart> before = scene.warm;
    separations(scene.queries);
    const std::vector<Separation> together = scene.answers;
    for (std::size_t k = 0; k < scene.queries.size(); ++k) {
      scene.warm[k] = before[k];
      separations(std::span(scene.queries).subspan(k, 1));
      SCOPED_TRACE(families::of_seed(seed, "scene", i) + ", pair " + std::to_string(k));
      EXPECT_EQ(scene.answers[k].distance, together[k].distance);
      EXPECT_EQ(scene.answers[k].p_WA, together[k].p_WA);
      EXPECT_EQ(scene.answers[k].extraction_W, together[k].extraction_W);
    }
  }
}

TEST(Separations, OptionsThatMakeNoSenseClaimNothing) {
  Rng rng(seed);
  Scene scene(rng, 9);
  separations(scene.queries);
  separations(scene.queries, {.iterations = 0});
  for (const Separation& s : scene.answers) EXPECT_EQ(s.end, QueryEnd::bad_input);
}

TEST(Separations, APoseThatIsNotFiniteHarmsNoOtherPair) {
  Rng rng(seed);
  Scene scene(rng, 12);
  separations(scene.queries);
  const std::vector<Separation> before = scene.answers;
  scene.X_WB[5].translation().y() = std::numeric_limits<double>::quiet_NaN();
  separations(scene.queries);
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
