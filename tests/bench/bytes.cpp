#include <benchmark/benchmark.h>

#include <algorithm>
#include <charconv>

#include "api/agents.h"
#include "api/monitor.h"
#include "house.h"
#include "micro.h"

// The cost of messages: writing percepts, reading actions and writing monitor frames, as S-expressions and as JSON.
// `bytes` is the size of the message.

namespace spark::bench {

namespace {
/// The percepts of a humanoid in a cycle with vision.
constexpr std::string_view kPercepts =
    "(time (now 131.42))(GS (unum 9) (team left) (sl 0) (sr 1) (t 61.40) (pm PlayOn))(GYR (n torso) (rt 0.21 -3.07 "
    "1.15))"
    "(ACC (n torso) (a -0.08 0.31 9.71))(HJ (n hj1) (ax -12.40))(HJ (n hj2) (ax -44.97))"
    "(See (G2R (pol 21.06 -3.14 1.97)) (G1R (pol 20.88 2.61 2.05)) (F1R (pol 22.91 24.06 -1.33)) (F2R (pol 23.75 "
    "-25.42 -1.27)) (B (pol 3.28 -7.91 -9.04))"
    " (P (team Blue) (id 4) (head (pol 8.12 17.55 -0.21)) (rlowerarm (pol 8.05 16.21 -1.94)) (llowerarm (pol 8.19 "
    "18.77 -1.90)) (rfoot (pol 8.14 17.02 -3.66)) (lfoot (pol 8.11 18.05 -3.71)))"
    " (P (team Red) (id 7) (rlowerarm (pol 1.92 -51.40 -11.73)) (rfoot (pol 2.04 -49.88 -16.25)))"
    " (L (pol 12.33 -19.42 -2.41) (pol 16.87 31.05 -1.76)) (L (pol 5.16 44.71 -5.52) (pol 9.88 -2.26 -2.97)))"
    "(HJ (n raj1) (ax -90.12))(HJ (n raj2) (ax -0.03))(HJ (n raj3) (ax 0.06))(HJ (n raj4) (ax 31.17))"
    "(HJ (n laj1) (ax -89.94))(HJ (n laj2) (ax 0.11))(HJ (n laj3) (ax -0.00))(HJ (n laj4) (ax -30.62))"
    "(HJ (n rlj1) (ax 0.42))(HJ (n rlj2) (ax -3.35))(HJ (n rlj3) (ax 38.71))(HJ (n rlj4) (ax -71.28))(HJ (n rlj5) (ax "
    "33.90))(HJ (n rlj6) (ax 3.12))"
    "(FRP (n rf) (c -0.01 0.02 -0.02) (f 1.48 -0.66 21.90))"
    "(HJ (n llj1) (ax 0.40))(HJ (n llj2) (ax 2.87))(HJ (n llj3) (ax 24.05))(HJ (n llj4) (ax -45.33))(HJ (n llj5) (ax "
    "22.74))(HJ (n llj6) (ax -2.98))"
    "(FRP (n lf) (c 0.02 0.01 -0.02) (f -0.37 0.52 23.18))";

/// The humanoid's reply.
constexpr std::string_view kActions =
    "(he1 1.23)(he2 -0.50)(rae1 0.07)(rae2 -2.81)(rae3 0.00)(rae4 3.14)(lae1 -0.35)(lae2 0.92)(lae3 -0.01)(lae4 -3.02)"
    "(rle1 0.44)(rle2 -1.08)(rle3 2.65)(rle4 -4.17)(rle5 1.96)(rle6 0.30)(lle1 0.41)(lle2 1.12)(lle3 -2.44)(lle4 "
    "-0.50)(lle5 -1.71)(lle6 -0.28)(beam -5.50 2.25 0.00)(syn)";

/// Copies an element. Texts that are numbers become numbers, as perceptors write them.
void addNumbers(const Element& from, Predicates& to) {
  if (from.isList()) {
    to.open();
    for (const Element e : from) addNumbers(e, to);
    to.close();
    return;
  }
  const std::string_view text = from.text();
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size())
    to.add(text);
  else if (text.find('.') == text.npos)
    to.add(static_cast<std::int64_t>(number));
  else
    to.add(number);
}

Predicates predicatesOf(std::string_view text) {
  Predicates read, out;
  readSexp(text, read);
  for (const Element e : read) addNumbers(e, out);
  return out;
}

/// A humanoid match whose monitor frame is encoded, with the parsers and encoders.
class Stage {
 public:
  Stage() {
    kernel().create("Node", "/bytes");
    for (const char* plugin : {"parser-sexp", "parser-json", "monitor-sexp", "monitor-json"})
      kernel().plugins().use(plugin);
  }
  Kernel& kernel() { return instance_.kernel(); }
  template <class T>
  T& helper(const char* type) {
    auto* parent = kernel().root().find<Node>("/bytes");
    Leaf* leaf = parent->find(type);
    return *(leaf ? *leaf : parent->create(type, type)).as<T>();
  }
  const MonitorFrame& frame() { return kernel().root().require<IMonitorServer>("/sys/server/monitor").frame(); }

 private:
  LocalEntrance entrance_;
  Instance instance_{{worldOf("rest22")}, entrance_};
};

/// Made once, when the first benchmark runs.
Stage& stage() {
  static Stage it;
  return it;
}

void count(benchmark::State& state, std::size_t bytes) { state.counters["bytes"] = static_cast<double>(bytes); }

void writePercepts(benchmark::State& state, const char* language) {
  auto& parser = stage().helper<IParser>(language);
  const Predicates percepts = predicatesOf(kPercepts);
  std::string out;
  for (auto _ : state) {
    out.clear();
    parser.write(percepts, out);
    benchmark::DoNotOptimize(out.data());
  }
  count(state, out.size());
}

/// Also converts each number, as effectors do.
void readActions(benchmark::State& state, const char* language) {
  auto& parser = stage().helper<IParser>(language);
  std::string message;
  parser.write(predicatesOf(kActions), message);
  Predicates read;
  for (auto _ : state) {
    read.clear();
    parser.parse(message, read);
    double sum = 0;
    for (const Element e : read) sum += e.at(1) ? e.at(1).number() : 0;
    benchmark::DoNotOptimize(sum);
  }
  count(state, message.size());
}

/// A diff contains every transform, as if all robots moved.
void writeFrame(benchmark::State& state, const char* language, bool full) {
  auto& encoder = stage().helper<IMonitorEncoder>(language);
  const MonitorFrame& frame = stage().frame();
  MonitorUpdate update{frame, full, {}, {}, {}};
  for (const auto& entry : frame.env.entries)
    if (full || entry.policy == EnvPolicy::always) update.env.push_back(entry.token);
  for (const FrameNode& node : frame.nodes) update.changed.push_back(node.kind == FrameNode::Kind::transform);
  std::string out;
  for (auto _ : state) {
    out.clear();
    encoder.encode(update, out);
    benchmark::DoNotOptimize(out.data());
  }
  count(state, out.size());
}
}  // namespace

void registerBytes() {
  for (const auto& [suffix, parser, encoder] :
       {std::tuple{"", "SexpParser", "SexpMonitor"}, std::tuple{"-json", "JsonParser", "JsonMonitor"}}) {
    const auto add = [suffix = std::string(suffix)](const char* name, auto work) {
      benchmark::RegisterBenchmark(("bytes/" + std::string(name) + suffix).c_str(), work)
          ->Unit(benchmark::kMicrosecond);
    };
    add("percepts", [parser = parser](benchmark::State& s) { writePercepts(s, parser); });
    add("action", [parser = parser](benchmark::State& s) { readActions(s, parser); });
    add("monitor-full", [encoder = encoder](benchmark::State& s) { writeFrame(s, encoder, true); });
    add("monitor-diff", [encoder = encoder](benchmark::State& s) { writeFrame(s, encoder, false); });
  }
}

}  // namespace spark::bench
