#include "state_at.h"

#include <fmt/format.h>

#include "api/phases.h"
#include "api/snapshots.h"
#include "host.h"
#include "spark/describe.h"
#include "spark/error.h"
#include "spark/output_file.h"
#include "tree_values.h"
#include "until.h"

namespace sparkhost {

using namespace spark;

namespace {
constexpr double kTolerance = Until::kTolerance;

bool hasInputs(const RecordedRun& run) { return run.recording().channelOf("/spark/inputs") != 0; }
}  // namespace

std::shared_ptr<const ForkState> stateAt(const RecordedRun& run, const Options& own) {
  if (!hasInputs(run)) {
    const double time = static_cast<double>(run.recording().end()) * 1e-9;
    if (std::abs(time - own.at) < kTolerance) return nullptr;
    throw Error(fmt::format("--at {0}: {1} is a snapshot and has no state up to {0} s but that of {2} s: omit --at",
                            own.at, run.file(), time));
  }
  Options again = own;
  again.replay = true;
  again.record.clear(), again.hashes.clear();
  again.switches.clear(), again.overrides.clear(), again.arguments.clear();
  again.check = again.histogram = false;
  const Options options = run.options(again);
  const outputs::Trial nothingIsWritten;
  Host host(options);
  host.build();
  Leaf& tape = host.play(run.file());
  const Node& root = host.kernel().root();
  callMethod(tape, "seek", std::vector<Value>{Value(own.at)});
  const auto now = [&root] { return numberAt(root, kSimulation, "time"); };
  const double step = numberAt(root, kSimulation, "step");
  if (now() + step <= own.at + kTolerance) {
    Until::add(host.kernel(), own.at, Until::Last::notLater);
    host.run();
    if (host.kernel().stopRequested()) throw Error("interrupted before the state from which the run would go on");
  }
  if (const Value differs = getProperty(tape, "differsAt"); differs.toInteger() >= 0)
    throw Error(fmt::format("--at {}: {} cannot be simulated again until then: cycle {} differs", own.at, run.file(),
                            differs.toInteger()));
  if (now() + step <= own.at + kTolerance)
    throw Error(fmt::format("--at {}: {} ends at {:.2f} s; without --at the run goes on from there", own.at, run.file(),
                            now()));
  ISnapshots& snapshots = host.kernel().root().require<ISnapshots>();
  Snapshot state;
  snapshots.take(state);
  auto out = std::make_shared<ForkState>();
  out->time = now();
  out->bytes = snapshots.write(state);
  for (const Sources::Source& s : host.kernel().sources().all())
    if (const std::string* text = host.kernel().sources().text(s.hash)) out->texts.push_back({s.kind, s.name, *text});
  return out;
}

}  // namespace sparkhost
