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

TEST(ExtractionChoice, SoundnessComesBeforeTheNumber) {
  ExtractionChoice choice(100, 0.05, 2, 0.5);
  choice.take(with(120, 0), 120);
  EXPECT_FALSE(choice.is_done());
  choice.take(with(101, 1), 101);
  EXPECT_TRUE(choice.is_done()) << "one is sound, and another try would be as near as this";
  EXPECT_EQ(choice.best().count(), 120);
}

TEST(ExtractionChoice, KnowsWhatLacksOnlySoundness) {
  ExtractionChoice choice(100, 0.05, 2, 0.5);
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
  ExtractionChoice choice(100, 0.05, 2, 0.5);
  choice.take(with(120, 2), 120);
  EXPECT_FALSE(choice.lacks_only_soundness(with(101, 1)));
}

}  // namespace
}  // namespace hybrid_quad
