#include "measure.h"

#include <algorithm>
#include <ctime>
#include <map>

#include "raw_world.h"

namespace spark::bench {

namespace {
constexpr int kBlock = 10;  // cycles

double median(std::vector<double> v) {
  if (v.empty()) return 0;
  std::sort(v.begin(), v.end());
  return v.size() % 2 ? v[v.size() / 2] : (v[v.size() / 2 - 1] + v[v.size() / 2]) / 2;
}

/// CPU time of this thread [µs]: both sides run in it, and other programs do not count.
double cpuMicros() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e6 * static_cast<double>(t.tv_sec) + 1e-3 * static_cast<double>(t.tv_nsec);
}

template <class F>
double microsPerCycle(F run) {
  const double start = cpuMicros();
  run();
  return (cpuMicros() - start) / kBlock;
}
}  // namespace

Result measure(const Case& c, int cycles) {
  House host(c), twin(c);
  RawWorld raw(twin);
  host.phases();
  std::vector<double> raws, hosts, ratios, contacts;
  std::map<std::string, std::vector<double>> phases;
  std::vector<std::string> order;
  const int blocks = std::max(2, cycles / kBlock);
  for (int i = 0; i < blocks; ++i) {
    double rawTime = 0, hostTime = 0;
    const auto runRaw = [&] { rawTime = microsPerCycle([&] { raw.run(kBlock); }); };
    const auto runHost = [&] { hostTime = microsPerCycle([&] { host.run(kBlock); }); };
    if (i % 2) runRaw(), runHost();
    else runHost(), runRaw();
    raws.push_back(rawTime);
    hosts.push_back(hostTime);
    ratios.push_back(hostTime / rawTime);
    contacts.push_back(raw.contacts());
    for (const auto& [name, micros] : host.phases()) {
      if (i == 0) order.push_back(name);
      phases[name].push_back(micros);
    }
  }
  Result r;
  r.bodies = raw.bodies();
  r.joints = raw.joints();
  r.agents = c.agents;
  r.contacts = median(contacts);
  r.raw = median(raws);
  r.host = median(hosts);
  r.ratio = median(ratios);
  r.perAgent = c.agents > 0 ? (r.host - r.raw) / c.agents : 0;
  for (const std::string& name : order) r.phases.emplace_back(name, median(phases[name]));
  return r;
}

}  // namespace spark::bench
