#include "realtime.h"

#include <fmt/format.h>

#include <cmath>

#include "crowd.h"
#include "tcp_entrance.h"

namespace spark::bench {

namespace {
constexpr double kStep = 0.02;  // s
constexpr int kWarm = 50;       // cycles before counting

Json toJson(const Value& v) {
  if (v.isString()) return v.toString();
  if (v.isInteger()) return v.toInteger();
  if (v.isNumber()) return v.toNumber();
  Json list = Json::array();
  for (const Value& e : v.toList()) list.push_back(toJson(e));
  return list;
}

Json play(const Setup& setup, double seconds, int line) {
  TcpEntrance entrance(line);
  Instance instance(setup, entrance);
  Leaf& loop = instance.kernel().root().require<Leaf>("/sys/server/simulation");
  setProperty(loop, "sync", false);
  setProperty(loop, "rate", "real");
  instance.run(kWarm);
  callMethod(loop, "resetTimers", {});
  instance.run(std::llround(seconds / kStep));
  return {{"times", toJson(getProperty(loop, "cycleTimes"))},
          {"histogram", toJson(getProperty(loop, "histogram"))},
          {"lateCycles", toJson(getProperty(loop, "lateCycles"))},
          {"table", callMethod(loop, "paceTable", {}).toString()}};
}

/// Number of cycles that were done within a step, from buckets {from, late, long, done}.
std::int64_t withinStep(const Json& histogram) {
  std::int64_t sum = 0;
  for (const Json& bucket : histogram)
    if (bucket[0].get<double>() < 1e6 * kStep) sum += bucket[3].get<std::int64_t>();
  return sum;
}

}  // namespace

Json realtime(const Setup& setup, double seconds, bool print) {
  Child child([&](int line) { return play(setup, seconds, line); });
  Crowd(setup.world, child.line()).serve();
  const Json played = child.result();
  Json row{{"world", setup.world.name},
           {"way", "realtime"},
           {"threads", setup.threads},
           {"solver", setup.solver},
           {"agents", setup.world.agents()}};
  row["cycles"] = played["times"][0][1];
  row["lateCycles"] = played["lateCycles"];
  row["withinStep"] = withinStep(played["histogram"]);
  for (const Json& t : played["times"])
    row[t[0].get<std::string>()] = {{"p50", t[2]}, {"p90", t[3]}, {"p99", t[4]}, {"p99.9", t[5]}, {"longest", t[6]}};
  if (print)
    fmt::print("{} in real time over TCP, {} late cycles\n{}", setup.world.title,
               played["lateCycles"].get<std::int64_t>(), played["table"].get<std::string>());
  return Json::array({row});
}

}  // namespace spark::bench
