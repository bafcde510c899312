#include <lgabench/core/parallel.hpp>
#include <lgabench/core/resources.hpp>

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>
#include <vector>

namespace lgabench {
namespace {

TEST(Parallel, EveryNumberOnce) {
  for (const std::size_t n : {0, 1, 2, 1000}) {
    std::vector<int> calls(n);
    in_parallel(n, [&](std::size_t i) { ++calls[i]; });
    EXPECT_EQ(calls, std::vector<int>(n, 1));
  }
}

TEST(Parallel, TwoAtOnce) {
  if (usable_cores() < 2) GTEST_SKIP() << "one core";
  std::atomic<int> arrived = 0;
  std::atomic<bool> met = false;
  const auto late = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  in_parallel(2, [&](std::size_t) {
    ++arrived;
    while (arrived < 2 && std::chrono::steady_clock::now() < late) std::this_thread::yield();
    met = arrived == 2;
  });
  EXPECT_TRUE(met);
}

TEST(Parallel, ThrowsWhatTheFirstByNumberThrows) {
  for (int repetition = 0; repetition < 50; ++repetition) {
    std::atomic<int> ended = 0;
    try {
      in_parallel(100, [&](std::size_t i) {
        if (i == 3) std::this_thread::sleep_for(std::chrono::microseconds(200));  // the others throw earlier
        ++ended;
        if (i >= 3) throw std::runtime_error(std::to_string(i));
      });
      FAIL() << "nothing thrown";
    } catch (const std::runtime_error& e) {
      EXPECT_STREQ(e.what(), "3");
    }
    EXPECT_GE(ended, 4);
  }
}

}  // namespace
}  // namespace lgabench
