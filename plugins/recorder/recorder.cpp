#include "recorder.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "foxglove.h"
#include "spark/error.h"
#include "spark/state.h"

namespace spark {

namespace {
mcap::Time nanoseconds(double seconds) { return static_cast<mcap::Time>(std::llround(seconds * 1e9)); }
constexpr const char* kHashSchema =
    R"({"type":"object","properties":{"cycle":{"type":"integer"},"state":{"type":"string"}}})";
}  // namespace

void Recorder::describe(Description<Recorder>& d) {
  d.doc("Records inputs, hashes and states of a run to a file.");
  d.implements<IInputTape>();
  d.link(&Recorder::simulation_, At<ISimulation>());
  d.property("file", &Recorder::file_).readOnly().ofProcess().doc("The file; empty: nothing is recorded.");
  d.property("every", &Recorder::every_)
      .unit("s")
      .min(0.02)
      .doc("Simulated time between two states that are written as a whole.");
  d.property("picture", &Recorder::picture_)
      .unit("s")
      .min(0)
      .doc("Simulated time between two pictures of the scene, for other programs; 0: none.");
  d.method("record", &Recorder::record).parameters({"file", "arguments"}).doc("Begins a recording.");
  d.method("finish", &Recorder::finish).doc("Ends the recording.");
  d.on<&Recorder::endCycle>(phase::kPublish);
}

Recorder::~Recorder() = default;

void Recorder::onUnlink() { finish(); }

void Recorder::record(std::string file, const std::vector<std::string>& arguments) {
  if (recording_) throw Error(fmt::format("{} records to {} already", path(), file_));
  recording_ = std::make_unique<recorder::Recording>(file, "Spark");
  file_ = std::move(file);
  inputs_.take();
  attached_.clear();
  failed_ = false;
  inputChannel_ = recording_->channel({0, std::string(recorder::kInputs), std::string(recorder::kInputsEncoding)});
  stateChannel_ = recording_->channel({0, std::string(recorder::kStates), std::string(recorder::kStatesEncoding)});
  hashChannel_ =
      recording_->channel({0, std::string(recorder::kHashes), "json"}, {"spark.Hash", "jsonschema", kHashSchema});
  logChannel_ = recording_->channel({0, "/log", "json"}, recorder::logSchema());
  if (picture_ > 0) {
    frames_ = std::make_unique<recorder::Frames>(kernel());
    shapeChannel_ = recording_->channel({0, "/scene", "json"}, recorder::shapesSchema());
    placeChannel_ = recording_->channel({0, "/tf", "json"}, recorder::placesSchema());
  }
  recording_->metadata("spark", {{"arguments", nlohmann::json(arguments).dump()},
                                 {"seed", std::to_string(kernel().seed())},
                                 {"configurationHash", fmt::format("{:016x}", configurationHash(kernel().root()))}});
  const double now = simulation_ ? simulation_->time() : 0;
  lastTime_ = nanoseconds(now);
  attachNewTexts(lastTime_);
  keyFrame(lastTime_, simulation_ ? simulation_->cycle() : 0);
  nextKeyFrame_ = now + every_;
  nextPicture_ = now;
  drawFrame(lastTime_);
  logSink_ = kernel().log().addSink(Level::info, [this](Level level, std::string_view line) { note(level, line); });
}

/// Takes a line of the log, from any thread. Who reads the recording must not get the right to change a run.
void Recorder::note(Level level, std::string_view line) {
  constexpr std::string_view kToken = "#token=";
  const std::size_t secret = std::min(line.find(kToken), line.size());
  const mcap::Time at = lastTime_;
  recording_->message(logChannel_, at, recorder::logMessage(at, level, line.substr(0, secret)));
}

void Recorder::finish() {
  if (!recording_) return;
  kernel().log().removeSink(logSink_);
  if (std::string rest = inputs_.take(); !rest.empty()) recording_->message(inputChannel_, lastTime_, std::move(rest));
  recording_.reset();
  frames_.reset();
  file_.clear();
}

bool Recorder::put(const Input& input) {
  if (recording_) inputs_.add(input);
  return true;
}

IInputTape::Clock::time_point Recorder::time(Clock::time_point live) {
  using std::chrono::nanoseconds;
  put({.kind = Input::Kind::time, .number = std::chrono::duration_cast<nanoseconds>(live.time_since_epoch()).count()});
  return live;
}

bool Recorder::decide(std::string_view what, std::uint64_t key, bool live, bool usual) {
  if (live != usual) put({.kind = Input::Kind::decision, .place = what, .key = key});
  return live;
}

void Recorder::endCycle(const Event& event) {
  if (!recording_) return;
  // All that came in this cycle is known now; time is that of its end.
  const double end = simulation_ ? simulation_->time() : event.time;
  lastTime_ = nanoseconds(end);
  attachNewTexts(lastTime_);
  recording_->message(inputChannel_, lastTime_, inputs_.take());
  recording_->message(hashChannel_, lastTime_,
                      fmt::format("{{\"cycle\":{},\"state\":\"{:016x}\"}}", event.cycle, stateHash(kernel().root())));
  if (end >= nextKeyFrame_ - 1e-9) {
    keyFrame(lastTime_, event.cycle);
    nextKeyFrame_ += every_;
  }
  drawFrame(lastTime_);
  if (failed_) return;
  if (const std::string why = recording_->failure(); !why.empty()) {
    failed_ = true;
    kernel().log().error("{}: the recording {} ends at {:.2f} s: {}", path(), file_, end, why);
  }
}

void Recorder::keyFrame(mcap::Time time, std::int64_t cycle) {
  StateWriter state(true);
  saveTree(kernel().root(), state);
  StateWriter frame(true);
  frame.write(cycle);
  frame.write(configurationHash(kernel().root()));
  frame.write(state.bytes());
  recording_->message(stateChannel_, time, frame.bytes());
}

void Recorder::drawFrame(mcap::Time time) {
  if (!frames_ || static_cast<double>(time) * 1e-9 < nextPicture_ - 1e-9) return;
  nextPicture_ += picture_;
  if (frames_->refresh()) recording_->message(shapeChannel_, time, frames_->shapes(time));
  recording_->message(placeChannel_, time, frames_->places(time));
}

/// Files may be read later as well, such as a robot's when an agent joins.
void Recorder::attachNewTexts(mcap::Time time) {
  const Sources& sources = kernel().sources();
  if (sources.all().size() == attached_.size()) return;
  for (const Sources::Source& s : sources.all())
    if (const std::string* text = sources.text(s.hash); attached_.insert(s).second && text)
      recording_->attachment(time, s.kind + ":" + s.name, "application/octet-stream", *text);
}

}  // namespace spark
