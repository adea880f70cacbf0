#include "measure.h"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <fstream>
#include <map>

#include "crowd.h"
#include "raw_world.h"
#include "spark/error.h"
#include "tcp_entrance.h"

namespace spark::bench {

namespace {
constexpr int kBlock = 10;  // cycles
constexpr int kWarm = 20;   // cycles before memory is measured

/// CPU time of this process and wall time [us].
struct Clocks {
  double cpu = 0, wall = 0;
  static Clocks now() {
    timespec t{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    const auto wall = std::chrono::steady_clock::now().time_since_epoch();
    return {1e6 * static_cast<double>(t.tv_sec) + 1e-3 * static_cast<double>(t.tv_nsec),
            std::chrono::duration<double, std::micro>(wall).count()};
  }
};

template <class F>
Clocks perCycle(F run) {
  const Clocks start = Clocks::now();
  run();
  const Clocks end = Clocks::now();
  return {(end.cpu - start.cpu) / kBlock, (end.wall - start.wall) / kBlock};
}

/// Peak memory of this process [MB].
double peakMegabytes() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("VmHWM:")) return std::stod(line.substr(6)) / 1024;
  return 0;
}

/// The measurements of all blocks of one kind.
struct Series {
  std::vector<double> cpu, wall, ratio, speedup;
  std::vector<std::pair<std::string, std::vector<double>>> parts;
  void add(Clocks c) {
    cpu.push_back(c.cpu);
    wall.push_back(c.wall);
  }
  void add(const Phases& phases) {
    if (parts.empty())
      for (const auto& [name, micros] : phases) parts.emplace_back(name, std::vector<double>{});
    for (std::size_t i = 0; i < phases.size(); ++i) parts[i].second.push_back(phases[i].second);
  }
};

Json row(const World& world, const char* way, int threads, const std::string& solver, const Series& s) {
  const double cpu = median(s.cpu), wall = median(s.wall);
  Json r{{"world", world.name}, {"way", way}, {"threads", threads}, {"solver", solver}, {"agents", world.agents()}};
  r["cpuMicros"] = cpu;
  r["wallMicros"] = wall;
  if (!s.ratio.empty()) r["ratio"] = median(s.ratio);
  if (!s.speedup.empty()) r["speedup"] = median(s.speedup);
  r["cyclesPerSecond"] = 1e6 / wall;
  r["agentStepsPerSecond"] = 1e6 / wall * world.agents();
  r["cpuPerSimulatedSecond"] = 1e-6 * cpu / 0.02;
  for (const auto& [name, micros] : s.parts)
    r[name] = quantile(micros, 0.25);  // wall time: other load can only increase it
  return r;
}

/// Two equal instances, one of which is stepped by the raw side.
class Comparison {
 public:
  Comparison(const Setup& setup, Way way, Entrance& entrance)
      : setup_(setup),
        way_(way),
        host_(one(setup), entrance),
        memory_((host_.run(kWarm), peakMegabytes())),
        twin_(dense(setup), twinEntrance_),
        raw_(twin_) {}

  Json play(int cycles) {
    host_.phases();
    const int blocks = std::max(3, cycles / kBlock);
    for (int i = 0; i < blocks; ++i) block(i);
    return rows();
  }
  Instance& host() { return host_; }

 private:
  static Setup one(Setup s) { return s.threads = 1, s; }
  /// For the raw side, which uses the dense solver. It gets the host's state, so it does not need to build a heap.
  static Setup dense(Setup s) {
    s.threads = 1;
    s.solver = "dense";
    if (s.world.motion == World::Motion::heap) s.world.motion = World::Motion::moving;
    return s;
  }

  void block(int i) {
    raw_.follow(host_);
    Clocks raw, alone;
    const auto runRaw = [&] {
      raw = perCycle([&] { raw_.run(kBlock); });
      const auto [collide, solve] = raw_.phases();
      raws_.add(Phases{{"collide", collide}, {"solve", solve}});
    };
    const auto runHost = [&] { alone = perCycle([&] { host_.run(kBlock); }), alone_.add(host_.phases()); };
    if (i % 2)
      runRaw(), runHost();
    else
      runHost(), runRaw();
    contacts_.push_back(raw_.contacts());
    awake_.push_back(raw_.awake());
    raws_.add(raw);
    alone_.add(alone);
    alone_.ratio.push_back(alone.cpu / raw.cpu);
    if (setup_.threads > 1) together(raw, alone);
  }

  void together(Clocks raw, Clocks alone) {
    host_.setThreads(setup_.threads);
    const Clocks all = perCycle([&] { host_.run(kBlock); });
    host_.setThreads(1);
    together_.add(host_.phases());
    together_.add(all);
    together_.ratio.push_back(all.cpu / raw.cpu);
    together_.speedup.push_back(alone.wall / all.wall);
  }

  Json rows() {
    Json out = Json::array();
    Json raw = row(setup_.world, "raw", 1, "dWorldStep", raws_);
    raw["bodies"] = raw_.bodies();
    raw["awake"] = median(awake_);
    raw["joints"] = raw_.joints();
    raw["contacts"] = median(contacts_);
    out.push_back(raw);
    for (const Series* s : {&alone_, &together_}) {
      if (s->cpu.empty()) continue;
      Json r = row(setup_.world, nameOf(way_), s == &alone_ ? 1 : setup_.threads, setup_.solver, *s);
      r["rawMicros"] = median(raws_.cpu);
      r["peakMegabytes"] = memory_;
      r["cycles"] = host_.cycles();
      r["hash"] = fmt::format("{:016x}", host_.hash());
      out.push_back(r);
    }
    return out;
  }

  Setup setup_;
  Way way_;
  Instance host_;
  double memory_;
  LocalEntrance twinEntrance_;
  Instance twin_;
  RawWorld raw_;
  Series raws_, alone_, together_;
  std::vector<double> contacts_, awake_;
};

/// Sizes of the messages [bytes], measured over some more cycles.
Json bytes(Instance& instance, LocalPort& port) {
  constexpr int kCycles = 20;
  Json out;
  Leaf* monitor = instance.kernel().root().find("/sys/server/monitor");
  port.resetTraffic();
  instance.run(kCycles);
  out["perceptBytes"] = port.percepts().mean();
  if (!monitor) return out;
  out["monitorPartialBytes"] = port.frames().mean();
  callMethod(*monitor, "requestFullState", {});
  port.resetTraffic();
  instance.run(kCycles);
  out["monitorFullBytes"] = port.frames().longest;
  return out;
}

Json measureLocal(const Setup& setup, int cycles) {
  LocalEntrance entrance;
  Comparison match(setup, Way::host, entrance);
  Json rows = match.play(cycles);
  const Json sizes = bytes(match.host(), entrance.port());
  for (std::size_t i = 1; i < rows.size(); ++i) rows[i].update(sizes);
  return rows;
}

Json measureTcp(const Setup& setup, int cycles, int line) {
  TcpEntrance entrance(line);
  return Comparison(setup, Way::tcp, entrance).play(cycles);
}
}  // namespace

const char* nameOf(Way way) { return way == Way::host ? "host" : "tcp"; }

double quantile(std::vector<double> v, double share) {
  if (v.empty()) return 0;
  std::sort(v.begin(), v.end());
  const double at = share * static_cast<double>(v.size() - 1);
  const auto below = static_cast<std::size_t>(at), above = std::min(below + 1, v.size() - 1);
  return v[below] + (at - static_cast<double>(below)) * (v[above] - v[below]);
}

Json measure(const Setup& setup, Way way, int cycles) {
  Child child(
      [&](int line) { return way == Way::tcp ? measureTcp(setup, cycles, line) : measureLocal(setup, cycles); });
  if (way == Way::tcp) Crowd(setup.world, child.line()).serve();
  return child.result();
}

}  // namespace spark::bench
