#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "hybrid_quad/pipeline/count_search.h"

namespace hybrid_quad {
namespace {

double least_error(double wanted, int tries, const std::function<double(double)>& outcome) {
  CountSearch search(wanted);
  double least = 1e9;
  for (int i = 0; i < tries; ++i) {
    const double got = outcome(search.next());
    least = std::min(least, std::abs(std::log(got / wanted)));
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

TEST(CountSearch, StaysBetweenWhatGivesTooFewAndTooMany) {
  // Rows that flip together: no number between.
  const auto outcome = [](double asked) { return asked < 491 ? 440.0 : 560.0; };
  CountSearch search(500);
  double few = 0, many = 1e9;
  std::vector<double> asked;
  for (int i = 0; i < 5; ++i) {
    EXPECT_GT(search.next(), few);
    EXPECT_LT(search.next(), many);
    EXPECT_EQ(std::count(asked.begin(), asked.end(), search.next()), 0);
    asked.push_back(search.next());
    (outcome(search.next()) < 500 ? few : many) = search.next();
    search.record(outcome(search.next()));
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
