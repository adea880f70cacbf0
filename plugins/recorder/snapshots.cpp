#include "snapshots.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "about.h"
#include "input_codec.h"
#include "mcap.h"
#include "shape.h"
#include "spark/error.h"
#include "spark/output_file.h"
#include "spark/random.h"
#include "spark/state.h"

namespace spark {

void Snapshots::describe(Description<Snapshots>& d) {
  d.doc("Takes snapshots of a run, and goes on from them.");
  d.implements<ISnapshots>();
  d.link(&Snapshots::simulation_, At<ISimulation>());
  d.link(&Snapshots::tape_, At<IInputTape>());
  d.property("arguments", &Snapshots::arguments_).ofProcess().doc("The command line of the program, for files.");
  d.method("save", &Snapshots::save)
      .parameters({"file", "replace"})
      .optional(1)
      .doc(
          "Writes a snapshot of the state between the last cycle and the next one. A file that exists is not "
          "replaced unless `replace` says so.");
  d.method("load", &Snapshots::loadFile)
      .parameters({"file", "time [s]"})
      .doc("Goes on from the newest state of a snapshot or a recording that is not later than a simulated time.");
}

void Snapshots::onLink() { kernel().events().define(kRestored, Order::parentsFirst, "A snapshot was restored."); }

void Snapshots::take(Snapshot& out, bool whole) {
  out.cycle = simulation_ ? simulation_->cycle() : 0;
  out.structure = kernel().structureVersion();
  out.shape = whole ? std::make_shared<const TreeShape>(kernel(), id()) : nullptr;
  StateWriter state(std::move(out.state));
  saveTree(kernel().root(), state);
  out.state = state.take();
}

void Snapshots::restore(const Snapshot& snapshot, std::optional<std::uint64_t> seed) {
  Node& root = kernel().root();
  if (!snapshot.shape && snapshot.structure != kernel().structureVersion())
    throw Error(fmt::format("{}: objects were made or removed since the snapshot; take whole ones to go back", path()));
  const bool other = snapshot.shape && !snapshot.shape->isHere(kernel());
  if (other) snapshot.shape->restore(kernel(), id());
  const bool branches = seed && *seed != kernel().seed();
  StateReader in(snapshot.state, branches ? hashBytes("branch", *seed) | 1 : 0);
  loadTree(root, in);
  if (!in.atEnd()) throw Error(fmt::format("{}: the snapshot has more state than the tree", path()));
  Event event;
  event.name = "restored";
  event.cycle = snapshot.cycle;
  event.time = simulation_ ? simulation_->time() : 0;
  kernel().events().channel(event.name).emit(event);
  if (branches) kernel().setSeed(*seed);
  if (other && !branches && configurationHash(root) != snapshot.shape->configuration())
    kernel().log().warning(
        "{}: the configuration is another one than that of the snapshot: a file that was read has another text, or a "
        "setting was not taken",
        path());
}

std::string Snapshots::write(const Snapshot& snapshot) const {
  if (!snapshot.shape) throw Error(fmt::format("{}: expected a whole snapshot, found a state alone", path()));
  return recorder::snapshotBytes(snapshot);
}

std::string recorder::snapshotBytes(const Snapshot& snapshot) {
  StateWriter out(true);
  out.write(snapshot.cycle);
  out.write(snapshot.shape->configuration());
  out.write(snapshot.state);
  snapshot.shape->write(out);
  return out.take();
}

Snapshot Snapshots::read(std::string_view bytes) const {
  StateReader in(bytes);
  Snapshot out;
  out.cycle = in.readInteger();
  in.readInteger();
  out.state = in.readString();
  out.shape = std::make_shared<const TreeShape>(in);
  return out;
}

namespace {
bool isSameFile(const std::filesystem::path& a, const std::filesystem::path& b) {
  std::error_code failed;
  return std::filesystem::equivalent(a, b, failed) && !failed;
}
}  // namespace

void Snapshots::save(const std::string& file, bool replace) {
  if (tape_ && tape_->playing()) return;  // the recorded run did
  if (const Leaf* tape = tape_.leaf(); tape && isSameFile(file, getProperty(*tape, "file").plain()))
    throw Error(
        fmt::format("cannot write the snapshot {}: the recording of this run is there; take another name", file));
  FileDraft out(file, "the snapshot", replace);
  Snapshot now;
  take(now, true);
  const mcap::Time time = recorder::nanoseconds(simulation_ ? simulation_->time() : 0);
  mcap::Writer writer([&](std::string_view bytes) { out.write(bytes); }, "Spark");
  const std::uint16_t states =
      writer.channel({0, std::string(recorder::kStates), std::string(recorder::kStatesEncoding)});
  writer.metadata("spark", recorder::about(kernel(), arguments_));
  for (const Sources::Source& s : kernel().sources().all())
    if (const std::string* text = kernel().sources().text(s.hash))
      writer.attachment(time, recorder::attachmentName(s), recorder::kAttachmentType, *text);
  writer.message(states, time, write(now));
  writer.finish();
  out.finish();
  kernel().log().info("The snapshot {} is written: cycle {}.", file, now.cycle);
}

void Snapshots::load(const std::string& file, double seconds, std::optional<std::uint64_t> seed) {
  mcap::Reader reader(file);
  const auto at = recorder::stateBefore(reader, seconds);
  if (!at) throw Error(fmt::format("{} has no state up to {} s: it is no snapshot, or damaged", file, seconds));
  std::string newest;
  reader.forEach(reader.chunks()[at->chunk], [&](const mcap::Message& m) {
    if (m.channel == reader.channelOf(recorder::kStates) && m.time == at->time) newest = m.data;
    return newest.empty();
  });
  recorder::addTexts(reader, at->time, kernel().sources());
  const Snapshot found = read(newest);
  restore(found, seed);
  kernel().log().info("The run goes on from {}: cycle {}.", file, found.cycle);
}

}  // namespace spark
