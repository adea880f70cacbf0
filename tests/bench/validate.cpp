#include "validate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

namespace spark::bench {

namespace {
std::string played(Setup setup, int threads, std::int64_t cycles) {
  setup.threads = threads;
  Child child([&](int) {
    LocalEntrance entrance;
    Instance instance(setup, entrance);
    instance.run(cycles);
    return Json(fmt::format("{:016x}", instance.hash()));
  });
  return child.result();
}
}  // namespace

Json validate(const Setup& setup, int cycles, bool print) {
  Setup several = setup;
  several.threads = std::max(2, setup.threads);
  const Json measured = measure(several, Way::host, cycles).back();
  const auto run = measured["cycles"].get<std::int64_t>();
  Json row{{"world", setup.world.name}, {"solver", setup.solver}, {"cycles", run}, {"measured", measured["hash"]}};
  row["oneThread"] = played(setup, 1, run);
  row["again"] = played(setup, 1, run);
  row[fmt::format("{}Threads", several.threads)] = played(setup, several.threads, run);
  bool same = true;
  for (const auto& [key, value] : row.items())
    if (key != "world" && key != "solver" && key != "cycles") same = same && value == row["measured"];
  row["same"] = same;
  if (print)
    fmt::print("{:<12} {} cycles: {} {}\n", setup.world.name, run, row["measured"].get<std::string>(),
               same ? "measured, unmeasured, repeated, with several threads" : "DIFFERS: " + row.dump());
  std::fflush(stdout);
  return Json::array({row});
}

}  // namespace spark::bench
