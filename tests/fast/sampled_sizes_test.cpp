// Sizes from functions of many places at once.
#include "collarmesh/sampled_sizes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>
#include <thread>
#include <vector>

namespace collarmesh::sampled_sizes_test {
namespace {

constexpr Box box{.min = {-1, 0, 2}, .max = {3, 2, 2.5}};

/// A function that counts its calls.
struct Function {
  double (*at)(const Point&);
  std::size_t* calls;

  std::vector<double> operator()(const std::vector<Point>& places) const {
    ++*calls;
    std::vector<double> sizes;
    for (const Point& p : places) {
      EXPECT_TRUE(p.x >= -1 && p.x <= 3 && p.y >= 0 && p.y <= 2 && p.z >= 2 && p.z <= 2.5);
      sizes.push_back(at(p));
    }
    return sizes;
  }
};

std::vector<Point> places(std::size_t count) {
  std::mt19937_64 random(7);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution(low, high)(random);
  };
  std::vector<Point> found;
  for (std::size_t i = 0; i < count; ++i) found.push_back({between(-1, 3), between(0, 2), between(2, 2.5)});
  return found;
}

double linear(const Point& p) { return 0.01 + 0.02 * (p.x + 1) + 0.3 * p.y + 0.1 * p.z; }
double near_a_point(const Point& p) { return std::max(1e-4, 0.5 * distance(p, {0.3, 0.7, 2.2})); }

TEST(SampledSizes, LinearSizesAreExact) {
  std::size_t calls = 0;
  const SizeField field = sampled_sizes(Function{linear, &calls}, box);
  for (const Point& p : places(2000)) EXPECT_NEAR(field(p), linear(p), 1e-12);
  EXPECT_LT(calls, 200U);
}

TEST(SampledSizes, GridsAreAsFineAsTheSizes) {
  std::size_t calls = 0;
  const SizeField field = sampled_sizes(Function{near_a_point, &calls}, box);
  for (const Point& p : places(2000)) EXPECT_NEAR(field(p), near_a_point(p), 0.3 * near_a_point(p));
  for (const Point& p : {Point{0.3, 0.7, 2.2}, Point{0.3002, 0.7001, 2.2}})
    EXPECT_NEAR(field(p), near_a_point(p), 1e-4);
}

TEST(SampledSizes, OutsideTheNearestPlaceOfTheBoxCounts) {
  std::size_t calls = 0;
  const SizeField field = sampled_sizes(Function{linear, &calls}, box);
  EXPECT_DOUBLE_EQ(field({9, 1, 2}), linear({3, 1, 2}));
  EXPECT_DOUBLE_EQ(field({-9, -9, 9}), linear({-1, 0, 2.5}));
}

TEST(SampledSizes, AnswersDoNotDependOnWhoAsksFirst) {
  std::size_t calls = 0;
  const std::vector<Point> asked = places(20000);
  const SizeField field = sampled_sizes(Function{near_a_point, &calls}, box);
  std::vector<double> expected;
  for (const Point& p : asked) expected.push_back(field(p));
  const SizeField shared = sampled_sizes(Function{near_a_point, &calls}, box);
  std::vector<std::vector<double>> found(4);
  std::vector<std::thread> threads;
  for (std::size_t t = 0; t < found.size(); ++t)
    threads.emplace_back([&, t] {
      found[t].resize(asked.size());
      for (std::size_t i = 0; i < asked.size(); ++i) {
        const std::size_t k = t % 2 == 0 ? i : asked.size() - 1 - i;
        found[t][k] = shared(asked[k]);
      }
    });
  for (std::thread& thread : threads) thread.join();
  for (const std::vector<double>& each : found) EXPECT_EQ(each, expected);
}

TEST(SampledSizes, InfiniteSizesAndExceptions) {
  std::size_t calls = 0;
  const auto infinite = [](const Point&) -> double { return INFINITY; };
  EXPECT_EQ(sampled_sizes(Function{infinite, &calls}, box)({0, 1, 2}), INFINITY);
  const auto beside = [](const Point& p) -> double { return p.x < 1 ? 0.1 : INFINITY; };
  const SizeField field = sampled_sizes(Function{beside, &calls}, box);
  EXPECT_NEAR(field({0.999, 1, 2}), 0.1, 1e-12);
  EXPECT_EQ(field({1.1, 1, 2}), INFINITY);
  const auto fails = [](const std::vector<Point>&) -> std::vector<double> { throw std::runtime_error("no"); };
  EXPECT_THROW(sampled_sizes(fails, box), std::runtime_error);
}

}  // namespace
}  // namespace collarmesh::sampled_sizes_test
