#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "hybrid_quad/pipeline/count_search.h"

namespace hybrid_quad {
namespace {

double least_error(double wanted, int tries, const std::function<double(double)>& outcome) {
  CountSearch search(wanted);
  double least = 1e9;
  for (int i = 0; i < tries; ++i) {
    const double got = outcome(search.next());
    least = std::min(least, search.error(got));
    search.record(got);
  }
  return least;
}

TEST(CountSearch, AsksForWhatIsWantedFirst) { EXPECT_EQ(CountSearch(1234).next(), 1234); }

TEST(CountSearch, FindsTheWayThroughBiasAndSlope) {
  EXPECT_LT(least_error(1000, 2, [](double asked) { return 1.2 * asked; }), 1e-9);
  EXPECT_LT(least_error(1000, 3, [](double asked) { return 300 + 0.8 * asked; }), 0.02);
  EXPECT_LT(least_error(5000, 4, [](double asked) { return 2 * std::pow(asked, 0.8); }), 0.02);
  // Whole strips only.
  EXPECT_LT(least_error(800, 4, [](double asked) { return 20 * std::round(1.15 * asked / 20); }), 0.03);
}

TEST(CountSearch, IsNotStuckWhereAskingMakesADifference) {
  CountSearch search(1000);
  for (int i = 0; i < 4; ++i) {
    search.record(300 + 0.4 * search.next());
    EXPECT_FALSE(search.is_stuck());
  }
}

TEST(CountSearch, BearsWhatItCannotChange) {
  CountSearch search(500);
  EXPECT_FALSE(search.is_stuck());
  for (int i = 0; i < 10; ++i) {
    search.record(2000);
    EXPECT_GT(search.next(), 0);
    EXPECT_TRUE(std::isfinite(search.next()));
  }
  EXPECT_TRUE(search.is_stuck());
}

}  // namespace
}  // namespace hybrid_quad
