#include "export.h"

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <set>

#include "api/phases.h"
#include "hang_watch.h"
#include "host.h"
#include "json_value.h"
#include "program.h"
#include "recorded_run.h"
#include "spark/describe.h"
#include "spark/error.h"
#include "spark/output_file.h"
#include "until.h"

namespace sparkreplay {

using namespace spark;
namespace fs = std::filesystem;

namespace {

constexpr std::string_view kStates = "/spark/states";

mcap::Time nanoseconds(double seconds) {
  return std::isfinite(seconds) ? static_cast<mcap::Time>(std::llround(seconds * 1e9)) : INT64_MAX;
}

/// The time of the newest state up to `from`; of the first one if all are later.
mcap::Time beginOf(mcap::Reader& reader, mcap::Time from) {
  mcap::Time begin = -1;
  for (const mcap::Reader::Chunk& chunk : reader.chunks()) {
    if (begin >= 0 && chunk.begin > from) break;
    reader.forEach(chunk, [&](const mcap::Message& m) {
      if (m.channel == reader.channelOf(kStates) && (begin < 0 || m.time <= from)) begin = m.time;
      return true;
    });
  }
  if (begin < 0) throw Error("the recording has no state, so no part of it can be played");
  return begin;
}

std::int64_t cut(const Export& what) {
  mcap::Reader reader(what.file);
  const mcap::Time begin = beginOf(reader, nanoseconds(what.from)), end = nanoseconds(what.to);
  OutputFile out(what.out, "the export");
  mcap::Writer writer([&out](std::string_view b) { out.write(b); }, "Spark");
  for (const auto& [number, schema] : reader.schemas()) writer.schema(schema);
  for (const auto& [number, channel] : reader.channels()) writer.channel(channel);
  for (const auto& [name, values] : reader.metadata()) writer.metadata(name, values);
  for (const auto& a : reader.attachments())
    if (a.time <= end) writer.attachment(a.time, a.name, a.mediaType, reader.read(a));
  std::int64_t messages = 0;
  bool started = false;
  constexpr mcap::Time kChunk = 1'000'000'000;
  for (const mcap::Reader::Chunk& chunk : reader.chunks())
    reader.forEach(chunk, [&](const mcap::Message& m) {
      // What stands before the state is that of earlier cycles.
      started |= m.channel == reader.channelOf(kStates) && m.time == begin;
      if (!started || m.time > end) return true;
      if (writer.chunkBytes() > 0 && m.time - writer.chunkBegin() >= kChunk) writer.endChunk();
      writer.message(m.channel, m.time, m.data);
      ++messages;
      return true;
    });
  writer.finish();
  return messages;
}

/// A row in each cycle.
class Table : public Node {
  SPARK_CLASS(Table, Node)
 public:
  static void describe(Description<Table>& d) {
    d.doc("Writes properties to a file, a row for each cycle.");
    d.on<&Table::row>(phase::kPublish);
  }
  void begin(const Export& what) {
    what_ = &what;
    out_ = std::make_unique<OutputFile>(what.out, "the table");
    std::string head = "time";
    for (const std::string& p : what.properties) head += ',' + p;
    out_->write(head + '\n');
  }
  std::int64_t end() {
    if (!failure_.empty()) throw Error(fmt::format("cannot write the table {}: {}", what_->out, failure_));
    for (const std::string& p : what_->properties)
      if (rows_ > 0 && !found_.contains(p))
        throw Error(fmt::format("there was no {} at any time: see sparkctl tree, and sparkhost --describe CLASS", p));
    return rows_;
  }

 private:
  void row(const Event& event) {
    const double time = event.time;
    constexpr double kTolerance = 1e-6;  // s: time is a sum of steps
    if (time < what_->from - kTolerance || time > what_->to + kTolerance) return;
    std::string line = fmt::format("{:.3f}", time);
    for (const std::string& p : what_->properties) {
      const std::size_t dot = p.rfind('.');
      const Leaf* const node = kernel().root().find(p.substr(0, dot));  // it may come and go
      const Property* const property = node ? node->classObject()->property(p.substr(dot + 1)) : nullptr;
      if (property) found_.insert(p);
      const Value value = property ? property->get(*node) : Value();
      // A list as in the tables of sparkbatch.
      std::string text = value.isList() ? sparkhost::toJson(value).dump() : property ? value.plain() : std::string();
      if (text.find_first_of(",\"\n") != std::string::npos) {
        for (std::size_t i = 0; (i = text.find('"', i)) != std::string::npos; i += 2) text.insert(i, 1, '"');
        text.insert(0, 1, '"');
        text += '"';
      }
      line += ',' + text;
    }
    try {
      if (failure_.empty()) out_->write(line + '\n');
    } catch (const Error& e) {
      failure_ = e.what();
    }
    ++rows_;
  }
  const Export* what_ = nullptr;
  std::unique_ptr<OutputFile> out_;
  std::string failure_;  ///< why the file ends early
  std::int64_t rows_ = 0;
  std::set<std::string> found_;  ///< columns whose property was there
};

/// Simulates the recorded part again; `prepare`: is called before it runs, `done` after it.
template <class Prepare, class Done>
std::int64_t simulate(const Export& what, Prepare prepare, Done done) {
  sparkhost::RecordedRun recorded(what.file);
  sparkhost::Options own;
  own.logLevel = what.logLevel;
  own.pluginPaths = what.pluginPaths, own.scenePaths = what.scenePaths;
  own.replay = true;
  const sparkhost::Options options = recorded.options(own);
  sparkhost::Host host(options);
  sparkhost::HangWatch::install(host.kernel());
  host.build();
  Leaf& tape = host.play(what.file);
  if (what.from > 0) callMethod(tape, "seek", std::vector<Value>{Value(what.from)});
  sparkhost::watchSignals(host.kernel());
  Leaf& writer = prepare(host.kernel());
  if (std::isfinite(what.to)) {
    sparkhost::Until::add(host.kernel(), what.to, sparkhost::Until::Last::notEarlier);
  }
  host.run();
  if (host.kernel().stopRequested()) throw Error(fmt::format("interrupted: {} is not complete", what.out));
  return done(writer);
}

std::int64_t table(const Export& what) {
  return simulate(
      what,
      [&what](Kernel& kernel) -> Leaf& {
        kernel.registerClass<Table>();
        auto& made = kernel.create<Table>("Table", "/sys/host/table");
        made.begin(what);
        return made;
      },
      [](Leaf& made) { return made.as<Table>()->end(); });
}

std::int64_t monitorLog(const Export& what) {
  return simulate(
      what,
      [&what](Kernel& kernel) -> Leaf& {
        Node& monitor = kernel.root().require<Node>("/sys/server/monitor");
        Leaf* log = monitor.child("log");
        if (!log || log->classObject()->name() != "MonitorLog") log = &monitor.create("MonitorLog", "exportedLog");
        setProperty(*log, "file", what.out);
        setProperty(*log, "whilePlayed", true);
        return *log;
      },
      [](Leaf& log) { return getProperty(log, "records").toInteger(); });
}

}  // namespace

std::int64_t write(const Export& given) {
  Export what = given;
  what.out = fs::absolute(what.out).string();
  if (what.to < what.from)
    throw Error(fmt::format("expected --to not before --from, found {} and {}", what.to, what.from));
  sparkhost::refuseSameFile(what.out, what.file, "the recording that is read");
  const std::string extension = fs::path(what.out).extension();
  const bool isTable = extension == ".csv";
  if (isTable && what.properties.empty())
    throw Error("a table needs columns: --property /path.property, once for each");
  if (!isTable && !what.properties.empty()) throw Error("--property is for tables: --export FILE.csv");
  for (const std::string& p : what.properties)
    if (p.empty() || p.front() != '/' || p.rfind('.') == std::string::npos || p.rfind('.') < p.rfind('/'))
      throw Error(fmt::format("expected /path.property for a column, found '{}'", p));
  outputs::setReplace(what.force);
  outputs::permit(what.out);
  if (extension != ".mcap") OutputFile(what.out, "the export");  // a wrong name is told before the simulation
  const std::int64_t written = extension == ".mcap" ? cut(what) : isTable ? table(what) : monitorLog(what);
  if (written == 0) throw Error(fmt::format("{} has nothing between {} and {} s", what.file, what.from, what.to));
  return written;
}

}  // namespace sparkreplay
