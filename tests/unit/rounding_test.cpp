#include <gtest/gtest.h>

#include <lgabench/core/rounding.hpp>

namespace lgabench {
namespace {

TEST(Rounding, AHalfIsOneWhicheverWayItWasComputed) {
  EXPECT_EQ(fixed(29 / 40.), "0.73");
  EXPECT_EQ(fixed((.70 + .75) / 2), "0.73");
  EXPECT_EQ(fixed((.6 + .7 + .8 + .8) / 4), "0.73");
  EXPECT_EQ(fixed(.125), "0.13");
  EXPECT_EQ(signed_text(-.125), "-0.13");
  EXPECT_EQ(fixed(.124999), "0.12");
}

TEST(Rounding, AZeroHasNoSign) {
  EXPECT_EQ(fixed(-.001), "0.00");
  EXPECT_EQ(signed_text(-.001), "0.00");
  EXPECT_EQ(signed_text(.001), "0.00");
  EXPECT_EQ(signed_text(.1), "+0.10");
  EXPECT_EQ(signed_text(-.0314, 3), "-0.031");
}

}  // namespace
}  // namespace lgabench
