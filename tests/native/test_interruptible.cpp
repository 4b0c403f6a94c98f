#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <stdexcept>

#include "hybrid_quad/base/interruptible.h"

namespace hybrid_quad {
namespace {

TEST(Interruptible, AnswersAStopWhileTheWorkGoesOn) {
  // The work cannot end before the stop was answered: were it waited for, this test would hang.
  const auto released = std::make_shared<std::promise<void>>();
  const auto ended = std::make_shared<std::promise<void>>();
  std::future<void> wait_for_end = ended->get_future();
  std::atomic<int> polls{0};
  RunContext context;
  context.stage = "test";
  context.stop_requested = [&] { return ++polls > 2; };
  EXPECT_THROW(run_interruptibly(context, 0, [released, ended] {
    released->get_future().wait();
    ended->set_value();
  }), Cancelled);
  released->set_value();
  wait_for_end.get();
}

TEST(Interruptible, HandsResultsAndErrorsOn) {
  for (const bool may_stop : {false, true}) {
    RunContext context;
    if (may_stop) context.stop_requested = [] { return false; };
    const auto value = std::make_shared<int>(0);
    run_interruptibly(context, 0, [value] { *value = 7; });
    EXPECT_EQ(*value, 7);
    EXPECT_THROW(run_interruptibly(context, 0, [] { throw std::runtime_error("broken"); }), std::runtime_error);
  }
}

}  // namespace
}  // namespace hybrid_quad
