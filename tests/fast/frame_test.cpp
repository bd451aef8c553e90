// The frame for input far from the origin.
#include "refine/frame.h"

#include <gtest/gtest.h>

#include <random>

namespace collarmesh::frame_test {
namespace {

TEST(Frame, MovesFarInputWithoutRounding) {
  Box far;
  far.add(Point{1e6, -2e6 - 3, 0});
  far.add(Point{1e6 + 1, -2e6, 1});
  const Frame frame(far);
  EXPECT_EQ(frame.shift(), (Vector{1e6, -2e6, 0}));
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int k = 0; k < 1000; ++k) {
    const Point p{1e6 + unit(random), -2e6 - 3 * unit(random), unit(random)};
    EXPECT_EQ(frame.outside(frame.inside(p)), p);
    const Point made = frame.rounded({unit(random), -unit(random), unit(random)});
    EXPECT_EQ(frame.inside(frame.outside(made)), made);
  }
}

TEST(Frame, LeavesInputAroundTheOriginAlone) {
  Box box;
  box.add(Point{-1, 2, 0});
  box.add(Point{1, 5, 1});
  EXPECT_EQ(Frame(box).shift(), Vector{});
}

}  // namespace
}  // namespace collarmesh::frame_test
