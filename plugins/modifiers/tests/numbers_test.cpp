#include <catch2/catch.hpp>

#include "absence.h"
#include "bench.h"

// Modifiers of numbers: which ones they change, and what becomes of them. Random numbers have fixed seeds; the bounds
// of means and deviations are at least four standard errors wide.

using namespace spark;
using namespace spark::test;

namespace {
constexpr int kMany = 20000;

/// `(S (n 5) (id 7) (v 1 2 3) (w (x 4)))`: a name that is a digit, an integer, and numbers.
Predicates mixed() {
  Predicates p;
  p.open("S").open("n").add("5").close().open("id").add(7).close();
  p.open("v").add(1.0).add(2.0).add(3.0).close().open("w").open("x").add(4.0).close().close().close();
  return p;
}

std::string after(Bench& bench, Predicates lists) {
  bench.pass(lists);
  return textOf(lists);
}

/// What the chain makes of the same number in many cycles.
std::vector<double> repeated(Bench& bench, double value, int cycles = kMany) {
  std::vector<double> out;
  for (int i = 0; i < cycles; ++i) out.push_back(bench.senseAll({value})[0]);
  return out;
}
}  // namespace

TEST_CASE("All numbers with decimals change, at any depth; names and integers stay as they are") {
  Bench bench;
  bench.add("Bias", {{"mean", 10}});
  CHECK(after(bench, mixed()) == "(S (n 5) (id 7) (v 11.00 12.00 13.00) (w (x 14.00)))");
}

TEST_CASE("A field is an inner list by its name, and indices choose among its numbers") {
  Bench bench;
  Leaf& bias = bench.add("Bias", {{"mean", 10}});
  setProperty(bias, "field", "v");
  CHECK(after(bench, mixed()) == "(S (n 5) (id 7) (v 11.00 12.00 13.00) (w (x 4.00)))");
  setProperty(bias, "indices", List{0, 2, 9});
  CHECK(after(bench, mixed()) == "(S (n 5) (id 7) (v 11.00 2.00 13.00) (w (x 4.00)))");
  setProperty(bias, "field", "w");
  CHECK(after(bench, mixed()) == "(S (n 5) (id 7) (v 1.00 2.00 3.00) (w (x 14.00)))");
  setProperty(bias, "field", "");
  CHECK(after(bench, mixed()) == "(S (n 5) (id 7) (v 11.00 2.00 13.00) (w (x 4.00)))");
  setProperty(bias, "field", "none");
  CHECK(after(bench, mixed()) == "(S (n 5) (id 7) (v 1.00 2.00 3.00) (w (x 4.00)))");
}

TEST_CASE("Integers of a percept change if their field is named, and stay integers") {
  Bench bench;
  Leaf& bias = bench.add("Bias", {{"field", "id"}, {"mean", 1.4}});
  CHECK(after(bench, mixed()) == "(S (n 5) (id 8) (v 1.00 2.00 3.00) (w (x 4.00)))");
  setProperty(bias, "mean", -1.6);
  CHECK(after(bench, mixed()) == "(S (n 5) (id 5) (v 1.00 2.00 3.00) (w (x 4.00)))");
}

TEST_CASE("Each of several fields of one name counts its numbers from 0, and they have one error") {
  Bench bench;
  bench.add("Bias", {{"field", "pol"}, {"indices", List{1}}, {"sigma", 1}});
  Predicates lists;
  lists.open("See");
  for (const char* name : {"A", "B"}) lists.open(name).open("pol").add(1.0).add(2.0).close().close();
  lists.close();
  bench.pass(lists);
  const Element see = *lists.begin();
  const Element a = see.named("A").named("pol"), b = see.named("B").named("pol");
  CHECK(a.at(1).number() == 1);
  CHECK(a.at(2).number() != 2);
  CHECK(b.at(1).number() == 1);
  CHECK(b.at(2).number() == a.at(2).number());
}

TEST_CASE("In actions texts and integers can be numbers; the predicate is none, and other texts stay") {
  Bench bench;
  bench.add("Bias", {{"mean", 0.5}});
  CHECK(bench.act("(he1 1 -2e0 fast (3))") == "(he1 1.50 -1.50 fast (3.50))");
  CHECK(bench.act("(12 1)(12 2)") == "(12 1.50)(12 2.50)");
  CHECK(bench.act("(say \"a long text with 3 words\")") == "(say \"a long text with 3 words\")");
  Predicates integer;
  integer.open("he1").add(1).close();
  bench.pass(integer, Signal::Kind::action);
  CHECK(textOf(integer) == "(he1 1.50)");
}

TEST_CASE("Numbers that are not finite stay as they are") {
  Bench bench;
  bench.add("Backlash", {{"width", 1}});
  bench.add("Saturation", {{"least", -1}, {"most", 1}});
  const std::vector<double> strange{HUGE_VAL, -HUGE_VAL, std::nan("")};
  CHECK(bench.senseAll(strange)[0] == HUGE_VAL);
  CHECK(bench.senseAll(strange)[1] == -HUGE_VAL);
  CHECK(std::isnan(bench.senseAll(strange)[2]));
  CHECK(bench.senseAll({0.25, 0.5, 0.75}) == std::vector<double>{0.25, 0.5, 0.75});  // and leave nothing behind
}

TEST_CASE("Properties that are not finite are refused") {
  Bench bench;
  using Property = std::pair<const char*, const char*>;
  for (const auto& [name, property] : {Property("Gain", "gain"),
                                       {"Bias", "mean"},
                                       {"Bias", "sigma"},
                                       {"WhiteNoise", "sigma"},
                                       {"RandomWalk", "sigma"},
                                       {"Quantization", "step"},
                                       {"Backlash", "width"},
                                       {"Delay", "seconds"},
                                       {"Jitter", "seconds"}}) {
    INFO(name << '.' << property);
    Leaf& modifier = bench.add(name);
    const Value before = getProperty(modifier, property);
    for (const double bad : {HUGE_VAL, std::nan("")})
      CHECK_THROWS_WITH(setProperty(modifier, property, bad), Catch::Contains("expected") && Catch::Contains("found"));
    CHECK(getProperty(modifier, property) == before);
  }
  Leaf& saturation = bench.add("Saturation");
  for (const char* property : {"least", "most"}) {
    CHECK_THROWS_WITH(setProperty(saturation, property, std::nan("")), Catch::Contains("found nan"));
    CHECK_NOTHROW(setProperty(saturation, property, property[0] == 'l' ? -HUGE_VAL : HUGE_VAL));
  }
}

TEST_CASE("A number stays as it is if its result is not finite, which is logged once for each modifier") {
  Bench bench;
  SECTION("gain") { bench.add("Gain", {{"gain", 1e15}}); }
  SECTION("quantization") { bench.add("Quantization", {{"step", 1e-320}}); }
  SECTION("a chain") {
    bench.add("Bias", {{"mean", 1e15}});
    bench.add("Gain", {{"gain", -1e15}});
  }
  for (int i = 0; i < 3; ++i)
    for (const double v : bench.senseAll({1e300, -1e300})) CHECK(std::isfinite(v));
  CHECK(count(bench.text, "which cannot be sent: such numbers stay as they are.") == 1);
  CHECK_THAT(bench.text, Catch::Contains("/usr/sensor/"));
}

TEST_CASE("An integer of a percept stays as it is if its result does not fit into one") {
  Bench bench;
  bench.add("Gain", {{"field", "id"}, {"gain", 1e15}});
  CHECK(after(bench, mixed()) == "(S (n 5) (id 7000000000000000) (v 1.00 2.00 3.00) (w (x 4.00)))");
  CHECK(bench.text.empty());
  bench.add("Gain", {{"field", "id"}, {"gain", 1e4}});
  CHECK(after(bench, mixed()) == "(S (n 5) (id 7000000000000000) (v 1.00 2.00 3.00) (w (x 4.00)))");
  CHECK_THAT(bench.text, Catch::Contains(" (Gain) would make 7e+19 of 7000000000000000"));
}

TEST_CASE("White noise has its standard deviation and no memory") {
  Bench bench;
  bench.add("WhiteNoise", {{"sigma", 0.5}});
  const std::vector<double> values = repeated(bench, 3);
  const Sample sample(values);
  CHECK(std::abs(sample.mean - 3) < 0.015);
  CHECK(std::abs(sample.sigma - 0.5) < 0.01);
  for (const std::size_t lag : {1u, 2u, 10u}) CHECK(std::abs(autocorrelation(values, lag)) < 0.03);
  // 68.3 % of normally distributed numbers are within one standard deviation, 99.73 % within three.
  int one = 0, three = 0;
  for (const double v : values) one += std::abs(v - 3) < 0.5, three += std::abs(v - 3) < 1.5;
  CHECK(std::abs(one / double(kMany) - 0.6827) < 0.014);
  CHECK(std::abs(three / double(kMany) - 0.9973) < 0.0016);
}

TEST_CASE("White noise of two numbers, and of two modifiers, is independent") {
  Bench bench;
  std::vector<double> first, second;
  bench.add("WhiteNoise", {{"sigma", 1}, {"indices", List{0}}});
  bench.add("WhiteNoise", {{"sigma", 1}, {"indices", List{1, 2}}});
  std::vector<double> third;
  for (int i = 0; i < kMany; ++i) {
    const auto& v = bench.senseAll({0, 0, 0});
    first.push_back(v[0]), second.push_back(v[1]), third.push_back(v[2]);
  }
  CHECK(std::abs(correlation(first, second)) < 0.03);
  CHECK(std::abs(correlation(second, third)) < 0.03);
}

TEST_CASE("A bias is the same in all cycles; its errors of calibration have mean and standard deviation") {
  Bench bench;
  Leaf& bias = bench.add("Bias", {{"mean", 2}, {"sigma", 0.25}});
  const std::vector<double> zeros(4000, 0.0), offsets = bench.senseAll(zeros);
  CHECK(bench.senseAll(zeros) == offsets);
  const Sample sample(offsets);
  CHECK(std::abs(sample.mean - 2) < 0.02);
  CHECK(std::abs(sample.sigma - 0.25) < 0.015);
  CHECK(std::abs(autocorrelation(offsets, 1)) < 0.07);
  setProperty(bias, "sigma", 0);
  CHECK(bench.senseAll({1, -1}) == std::vector<double>{3, 1});
}

TEST_CASE("A random walk begins at 0, its variance grows with time, and its steps are independent") {
  Bench bench;
  bench.add("RandomWalk", {{"sigma", 0.5}});
  const std::vector<double> zeros(kMany / 4, 0.0);
  CHECK(bench.senseAll(zeros) == zeros);
  std::vector<double> early, late, steps;
  for (int cycle = 1; cycle <= 100; ++cycle) {  // 2 s
    bench.senseAll(zeros);
    if (cycle == 25) early = bench.sensed;
    if (cycle == 100) late = bench.sensed;
  }
  CHECK(std::abs(Sample(early).mean) < 0.025);
  CHECK(std::abs(Sample(early).sigma - 0.5 * std::sqrt(0.5)) < 0.02);
  CHECK(std::abs(Sample(late).mean) < 0.05);
  CHECK(std::abs(Sample(late).sigma - 0.5 * std::sqrt(2.0)) < 0.04);
  // The correlation of a Wiener process at times s and t is sqrt(s / t).
  CHECK(std::abs(correlation(early, late) - 0.5) < 0.05);

  std::vector<double> walk = repeated(bench, 0);
  for (std::size_t i = 1; i < walk.size(); ++i) steps.push_back(walk[i] - walk[i - 1]);
  CHECK(std::abs(Sample(steps).mean) < 0.002);
  CHECK(std::abs(Sample(steps).sigma - 0.5 * std::sqrt(0.02)) < 0.0015);
  CHECK(std::abs(autocorrelation(steps, 1)) < 0.03);
  CHECK(autocorrelation(walk, 1) > 0.999);
}

TEST_CASE("A random walk drifts with time, not with the number of percepts") {
  Bench bench;
  bench.add("RandomWalk", {{"sigma", 0.5}});
  const std::vector<double> zeros(kMany / 4, 0.0);
  bench.senseAll(zeros);
  for (int i = 0; i < 49; ++i) bench.senseNothing();
  CHECK(std::abs(Sample(bench.senseAll(zeros)).sigma - 0.5) < 0.025);  // 1 s
}

TEST_CASE("Quantization rounds to the nearest multiple of its step") {
  Bench bench;
  Leaf& quantization = bench.add("Quantization", {{"step", 0.25}});
  CHECK(bench.senseAll({0.1, 0.13, -0.3, -0.4, 7.5, 1e9}) == std::vector<double>{0, 0.25, -0.25, -0.5, 7.5, 1e9});
  setProperty(quantization, "step", 0);
  CHECK(bench.senseAll({0.1}) == std::vector<double>{0.1});
}

TEST_CASE("Saturation limits to its range") {
  Bench bench;
  bench.add("Saturation", {{"least", -2}, {"most", 3}});
  CHECK(bench.senseAll({-5, -2, 0.5, 3, 1e300}) == std::vector<double>{-2, -2, 0.5, 3, 3});
}

TEST_CASE("A gain multiplies") {
  Bench bench;
  bench.add("Gain", {{"gain", -0.5}});
  CHECK(bench.senseAll({4, -1}) == std::vector<double>{-2, 0.5});
}

TEST_CASE("Backlash: after a change of direction the gap is crossed first") {
  Bench bench;
  bench.add("Backlash", {{"width", 0.5}});
  const std::vector<double> inputs{1, 1.25, 1.5, 1.75, 1.5, 1.25, 1, 0.75, 1},
      outputs{1, 1, 1.25, 1.5, 1.5, 1.5, 1.25, 1, 1};
  for (std::size_t i = 0; i < inputs.size(); ++i)
    CHECK(bench.senseAll({inputs[i], -inputs[i]}) == std::vector<double>{outputs[i], -outputs[i]});
}

TEST_CASE("The chain is applied in the order of the children") {
  Bench bench;
  bench.add("Gain", {{"gain", 10}});
  bench.add("Bias", {{"mean", 1}});
  bench.add("Saturation", {{"most", 15}});
  CHECK(bench.senseAll({1, 2}) == std::vector<double>{11, 15});
  Bench other;
  other.add("Saturation", {{"most", 15}});
  other.add("Bias", {{"mean", 1}});
  other.add("Gain", {{"gain", 10}});
  CHECK(other.senseAll({1, 2}) == std::vector<double>{20, 30});
}

TEST_CASE("A modifier that is no child of a perceptor or an effector says so") {
  Bench bench;
  bench.kernel.create("Gain", "/usr/stray");
  CHECK_THAT(bench.text, Catch::Contains("/usr/stray has no effect: expected a perceptor or an effector as its parent, "
                                         "found /usr (Node)."));
}

TEST_CASE("Numbers stay within the limits of their sensor, and the one that says nothing stays as it is") {
  Bench bench;
  bench.measure({Measured::Kind::numbers, 0.1, 10, 10});
  SECTION("noise") {
    bench.add("WhiteNoise", {{"sigma", 5}});
    double low = 10, high = 0;
    for (const double v : repeated(bench, 5, 500)) low = std::min(low, v), high = std::max(high, v);
    CHECK(low == 0.1);
    CHECK(high == 10);
    for (const double v : repeated(bench, 10, 50)) CHECK(v == 10);
  }
  SECTION("what follows leaves it, too") {
    bench.add("Bias", {{"mean", -3}});
    bench.add("Gain", {{"gain", 0.5}});
    CHECK(bench.senseAll({10, 2, 8}) == std::vector<double>{10, 0.1, 2.5});
  }
}

TEST_CASE("What adds to a rotation turns it; what does not leaves it, and says so") {
  Bench bench;
  bench.measure({Measured::Kind::rotation});
  const auto turned = [&] { return bench.senseAll({1, 0, 0, 0}); };
  SECTION("a bias about one axis") {
    bench.add("Bias", {{"mean", 0.2}, {"indices", List{2}}});
    const std::vector<double> q = turned();
    CHECK(q[0] == Approx(std::cos(0.1)));
    CHECK(q[3] == Approx(std::sin(0.1)));
  }
  SECTION("noise keeps its length") {
    bench.add("WhiteNoise", {{"sigma", 0.5}});
    bench.add("RandomWalk", {{"sigma", 0.5}});
    double sum = 0;
    for (int i = 0; i < 2000; ++i) {
      const std::vector<double> q = turned();
      CHECK(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3] == Approx(1));
      sum += std::pow(2 * std::asin(q[1]), 2);
    }
    CHECK(sum > 0);
  }
  SECTION("a gain") {
    bench.add("Gain", {{"gain", 2}});
    CHECK(turned() == std::vector<double>{1, 0, 0, 0});
    CHECK_THAT(bench.text, Catch::Contains("leaves the rotation that /usr/sensor senses as it is"));
  }
}

TEST_CASE("A pose keeps its rotation one; its position has the error of its numbers") {
  Bench bench;
  bench.measure({Measured::Kind::pose});
  bench.add("Bias", {{"mean", 0.1}});
  const std::vector<double> m = bench.senseAll({1, 0, 0, 5, 0, 1, 0, 6, 0, 0, 1, 7, 0, 0, 0, 1});
  CHECK(m[3] == Approx(5.1));
  CHECK(m[7] == Approx(6.1));
  CHECK(m[11] == Approx(7.1));
  CHECK(m[12] == 0);
  CHECK(m[15] == 1);
  CHECK(m[0] * m[0] + m[4] * m[4] + m[8] * m[8] == Approx(1));
  CHECK(m[0] + m[5] + m[10] == Approx(1 + 2 * std::cos(0.1 * std::sqrt(3))));
}

TEST_CASE("Noise in proportion is a fraction of the number") {
  Bench bench;
  bench.add("WhiteNoise", {{"relative", 0.01}});
  double square = 0;
  for (const double v : repeated(bench, 50)) square += (v - 50) * (v - 50);
  CHECK(std::sqrt(square / kMany) == Approx(0.5).epsilon(0.03));
}

TEST_CASE("A modifier that finds no number says so once") {
  Bench bench;
  bench.add("Bias", {{"field", "speed"}, {"mean", 1}});
  for (int i = 0; i < 120; ++i) bench.sense(1);
  CHECK(count(bench.text, "has changed nothing so far") == 1);
  CHECK_THAT(bench.text, Catch::Contains("in a list 'speed'"));
}
