#include <gtest/gtest.h>

#include "hybrid_quad/pipeline/extraction.h"

namespace hybrid_quad {
namespace {

Extraction with(int quads, int flawed, int missed = 0) {
  Extraction extraction;
  extraction.mesh.quads.resize(quads);
  extraction.flawed = flawed;
  extraction.missed = missed;
  return extraction;
}

double as_far(const QuadMesh&) { return 0.01; }

TEST(ExtractionChoice, ALostLimbCountsForMoreThanAFewQuads) {
  const auto chosen = [](double distance_of_104, double distance_of_100) {
    ExtractionChoice choice(100, 0.03, 2, 0.5,
                            [&](const QuadMesh& quads) { return quads.quads.size() == 104 ? distance_of_104 : distance_of_100; });
    choice.take(with(104, 0), 104);
    EXPECT_FALSE(choice.is_done());
    choice.take(with(100, 0), 100);
    EXPECT_TRUE(choice.is_done());
    return choice.best().count();
  };
  EXPECT_EQ(chosen(0.02, 0.03), 100);
  EXPECT_EQ(chosen(0.02, 0.04), 104);
}

TEST(ExtractionChoice, MeasuresNoDistanceOfASingleTry) {
  ExtractionChoice choice(100, 0.03, 2, 0.5, [](const QuadMesh&) {
    ADD_FAILURE();
    return 0.0;
  });
  choice.take(with(100, 0), 100);
  EXPECT_EQ(choice.best().count(), 100);
}

TEST(ExtractionChoice, SoundnessComesBeforeTheNumber) {
  ExtractionChoice choice(100, 0.05, 2, 0.5, as_far);
  choice.take(with(120, 0), 120);
  EXPECT_FALSE(choice.is_done());
  choice.take(with(101, 1), 101);
  EXPECT_TRUE(choice.is_done()) << "one is sound, and another try would be as near as this";
  EXPECT_EQ(choice.best().count(), 120);
}

TEST(ExtractionChoice, KnowsWhatLacksOnlySoundness) {
  ExtractionChoice choice(100, 0.05, 2, 0.5, as_far);
  EXPECT_FALSE(choice.lacks_only_soundness(with(101, 1))) << "nothing sound is there yet";
  choice.take(with(120, 0), 120);
  EXPECT_TRUE(choice.lacks_only_soundness(with(101, 1)));
  EXPECT_FALSE(choice.lacks_only_soundness(with(101, 0))) << "it is sound";
  EXPECT_FALSE(choice.lacks_only_soundness(with(110, 1))) << "too many";
  EXPECT_FALSE(choice.lacks_only_soundness(with(101, 1, 1))) << "it misses a count";
  choice.take(with(101, 0), 101);
  EXPECT_TRUE(choice.is_done());
  EXPECT_EQ(choice.best().count(), 101);
}

TEST(ExtractionChoice, GoesOnWithFlawsWhereNoneIsSound) {
  ExtractionChoice choice(100, 0.05, 2, 0.5, as_far);
  choice.take(with(120, 2), 120);
  EXPECT_FALSE(choice.lacks_only_soundness(with(101, 1)));
}

}  // namespace
}  // namespace hybrid_quad
