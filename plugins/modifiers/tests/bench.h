#pragma once
/// \file
/// A sensor or an effector with a chain of modifiers, without agents: the test makes the signals.

#include <cmath>
#include <string>
#include <vector>

#include "api/modifier.h"
#include "spark/state.h"
#include "test_support.h"

namespace spark::test {

/// Senses nothing: the test makes its percepts.
class BenchSensor : public Perceptor {
  SPARK_CLASS(BenchSensor, Perceptor)
 public:
  static void describe(Description<BenchSensor>& d) { d.doc("A sensor."); }
  void sense(Predicates&, const Event&) override {}
};

/// The same, with numbers of which a test says what they are.
class BenchMeter : public BenchSensor, public IMeasurement {
  SPARK_CLASS(BenchMeter, BenchSensor)
 public:
  static void describe(Description<BenchMeter>& d) {
    d.doc("A sensor that says what it measures.");
    d.implements<IMeasurement>();
  }
  Measured measured() const override { return what; }
  Measured what;
};

/// The message text of predicates.
inline std::string textOf(const Predicates& lists, int decimals = 2) {
  std::string out;
  writeSexp(lists, decimals, out);
  return out;
}

/// `/usr/sensor` and the modifiers that the test adds to it.
struct Bench : TestHost {
  Bench() {
    for (const char* plugin : {"scene", "gamecontrol", "modifiers"}) kernel.plugins().use(plugin);
    kernel.registerClass<BenchSensor>();
    kernel.registerClass<BenchMeter>();
    sensor = &kernel.create<BenchSensor>("BenchSensor", "/usr/sensor");
  }
  /// Puts a sensor in its place that says what it measures.
  void measure(const Measured& what) {
    kernel.root().require<Node>("/usr").remove(*sensor);
    auto& meter = kernel.create<BenchMeter>("BenchMeter", "/usr/sensor");
    meter.what = what;
    sensor = &meter;
  }
  /// Adds a modifier to the end of the chain.
  Leaf& add(const char* className, const std::vector<std::pair<const char*, Value>>& properties = {}) {
    Leaf& made = sensor->create(className);
    for (const auto& [name, value] : properties) setProperty(made, name, value);
    return made;
  }
  /// Applies the chain once, a cycle of 0.02 s after the last time.
  void pass(Predicates& lists, Signal::Kind kind = Signal::Kind::percept) {
    Signal signal(kind, lists, 0);
    ++event.cycle;
    event.time = event.step * static_cast<double>(event.cycle);
    for (const auto& child : sensor->children()) child->as<Modifier>()->apply(signal, event);
  }
  /// The percept `(S value)` after the chain, as text; "" if it is missing.
  std::string sense(double value) {
    lists.clear();
    lists.open("S").add(value).close();
    pass(lists);
    return textOf(lists);
  }
  /// A cycle without a percept.
  std::string senseNothing() {
    lists.clear();
    pass(lists);
    return textOf(lists);
  }
  /// The numbers of the percept `(S values...)` after the chain, of which none is lost.
  const std::vector<double>& senseAll(const std::vector<double>& values) {
    lists.clear();
    lists.open("S");
    for (const double v : values) lists.add(v);
    lists.close();
    pass(lists);
    sensed.clear();
    for (const Element e : *lists.begin())
      if (!e.isText()) sensed.push_back(e.number());
    return sensed;
  }
  /// An action after the chain, with its numbers as texts before it, as parsers of S-expressions deliver them.
  std::string act(std::string_view action) {
    lists.clear();
    readSexp(action, lists);
    pass(lists, Signal::Kind::action);
    return textOf(lists);
  }

  BenchSensor* sensor;
  Event event{"sense", 0, 0.02, 0, nullptr};
  Predicates lists;
  std::vector<double> sensed;
};

/// Mean and standard deviation of numbers.
struct Sample {
  explicit Sample(const std::vector<double>& values) {
    for (const double v : values) mean += v / static_cast<double>(values.size());
    for (const double v : values) sigma += (v - mean) * (v - mean) / static_cast<double>(values.size());
    sigma = std::sqrt(sigma);
  }
  double mean = 0, sigma = 0;
};

/// Correlation of two lists of the same length.
inline double correlation(const std::vector<double>& a, const std::vector<double>& b) {
  const Sample x(a), y(b);
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - x.mean) * (b[i] - y.mean);
  return sum / static_cast<double>(a.size()) / (x.sigma * y.sigma);
}

/// Correlation of each number with the one that comes `lag` later.
inline double autocorrelation(const std::vector<double>& values, std::size_t lag) {
  const auto n = static_cast<std::ptrdiff_t>(lag);
  return correlation({values.begin(), values.end() - n}, {values.begin() + n, values.end()});
}

}  // namespace spark::test
