#include "simulation/histogram.h"

#include <catch2/catch.hpp>

using spark::simulation::Histogram;
using std::chrono::microseconds;
using std::chrono::seconds;

TEST_CASE("The buckets of a histogram increase, and their width is at most a sixteenth of their lower bound") {
  for (std::size_t i = 0; i + 1 < Histogram::kBuckets; ++i) {
    const double from = Histogram::begin(i), to = Histogram::begin(i + 1);
    CAPTURE(i, from, to);
    REQUIRE(to > from);
    REQUIRE(to - from <= std::max(1.0, from / 16));
  }
}

TEST_CASE("A duration is counted in the bucket that contains it") {
  for (const int micros : {0, 1, 31, 32, 33, 1000, 20000, 20479, 20480, 60'000'000}) {
    Histogram h;
    h.add(microseconds(micros));
    for (std::size_t i = 0; i < Histogram::kBuckets; ++i)
      if (h.inBucket(i)) CHECK((Histogram::begin(i) <= micros && micros < Histogram::begin(i + 1)));
    CHECK(h.percentile(0.5) >= micros);
    CHECK(h.longest() == micros);
  }
}

TEST_CASE("Durations out of range are counted in the first or the last bucket") {
  Histogram h;
  h.add(microseconds(-5));
  h.add(seconds(1'000'000));
  CHECK(h.inBucket(0) == 1);
  CHECK(h.inBucket(Histogram::kBuckets - 1) == 1);
}

TEST_CASE("Percentiles are accurate to a sixteenth") {
  Histogram h;
  CHECK(h.percentile(0.5) == 0);
  for (int i = 1; i <= 1000; ++i) h.add(microseconds(10 * i));
  CHECK(h.count() == 1000);
  CHECK(h.percentile(0.5) == Approx(5000).epsilon(1.0 / 16));
  CHECK(h.percentile(0.999) == Approx(9990).epsilon(1.0 / 16));
  CHECK(h.percentile(1) == 10000);
  h.reset();
  CHECK(h.count() == 0);
  CHECK(h.percentile(1) == 0);
}
