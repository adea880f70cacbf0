#include "recorder.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "about.h"
#include "api/credentials.h"
#include "foxglove.h"
#include "shape.h"
#include "snapshots.h"
#include "spark/error.h"
#include "spark/state.h"

namespace spark {

namespace {
constexpr const char* kHashSchema =
    R"({"type":"object","properties":{"cycle":{"type":"integer"},"state":{"type":"string"}}})";
}  // namespace

void Recorder::describe(Description<Recorder>& d) {
  d.doc("Records inputs, hashes and states of a run to a file.");
  d.implements<IInputTape>();
  d.link(&Recorder::simulation_, At<ISimulation>());
  d.link(&Recorder::snapshots_, At<ISnapshots>());
  d.link(&Recorder::monitor_, At<IMonitorServer>());
  d.property("file", &Recorder::file_).readOnly().ofProcess().doc("The file; empty: nothing is recorded.");
  d.property("every", &Recorder::every_)
      .unit("s")
      .min(0.02)
      .doc("Simulated time between two states that are written as a whole.");
  d.property("picture", &Recorder::picture_)
      .unit("s")
      .min(0)
      .doc("Simulated time between two pictures of the scene, for other programs; 0: none.");
  d.property("frames", &Recorder::framesPerSecond_)
      .unit("1/s")
      .min(0)
      .max(50)
      .doc("Frames of the match in a simulated second, for the page that plays recordings; 0: none.");
  d.property("hashEvery", &Recorder::hashEvery_)
      .unit("cycles")
      .range(1, 1000000)
      .doc("Cycles between two hashes of the state: a simulation that differs is noticed after as many at most.");
  d.method("record", &Recorder::record).parameters({"file", "arguments"}).doc("Begins a recording.");
  d.method("finish", &Recorder::finish).doc("Ends the recording.");
  d.method("discard", &Recorder::discard).doc("Ends the recording, and removes its file if it was new.");
  d.on<&Recorder::beforePublish>(phase::kSense);
  d.on<&Recorder::endCycle>(phase::kPublish);
}

Recorder::~Recorder() = default;

void Recorder::onUnlink() { finish(); }

void Recorder::record(std::string file, const std::vector<std::string>& arguments) {
  if (recording_) throw Error(fmt::format("{} records to {} already", path(), file_));
  if (!snapshots_) kernel().create("Snapshots", ISnapshots::kPath);
  recording_ = std::make_unique<recorder::Recording>(file, "Spark");
  file_ = std::move(file);
  inputs_ = {};
  inputWriter_ = std::make_shared<recorder::InputWriter>();
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
  if (monitor_ && framesPerSecond_ > 0)
    match_ = std::make_unique<recorder::MatchChannels>(*recording_, framesPerSecond_);
  recording_->metadata("spark", recorder::about(kernel(), arguments));
  const double now = simulation_ ? simulation_->time() : 0;
  lastTime_ = recorder::nanoseconds(now);
  attachNewTexts(lastTime_);
  keyFrame(lastTime_);
  nextKeyFrame_ = now + every_;
  nextPicture_ = now;
  drawFrame(lastTime_);
  recording_->flush();  // whenever the program is killed, the file has the beginning
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
  // What came after the last cycle, and the end: a state with that.
  mcap::Time end = lastTime_;
  if (!inputs_.empty()) writeInputs(++end);
  if (!kernel().isEnding() && simulation_ && (end > lastTime_ || simulation_->cycle() != stateCycle_)) keyFrame(end);
  if (match_) match_->finish(end);
  match_.reset();
  if (const std::string why = recording_->end(); !why.empty() && !failed_)
    kernel().log().error("{}: the recording {} lacks its end: {}", path(), file_, why);
  recording_.reset();
  frames_.reset();
  file_.clear();
}

void Recorder::discard() {
  if (recording_) recording_->discard();
  finish();
}

bool Recorder::put(const Input& input) {
  if (!recording_ || failed_) return true;
  if (input.kind == Input::Kind::request) {
    const std::string text = withoutSecrets(input.text);
    Input public_ = input;
    public_.text = text;
    inputs_.add(public_);
  } else {
    inputs_.add(input);
  }
  return true;
}

/// The line of a request without the arguments that are secrets: no reader of the recording may learn them.
std::string Recorder::withoutSecrets(std::string_view request) const {
  using Json = nlohmann::json;
  Json json = Json::parse(request, nullptr, false);
  const auto word = [&json](const char* key) {
    const auto at = json.find(key);
    return at != json.end() && at->is_string() ? at->get<std::string>() : std::string();
  };
  const bool calls = json.is_object() && word("do") == "call";
  const Leaf* const leaf = calls ? kernel().root().find(word("path")) : nullptr;
  const Method* const method = leaf ? leaf->classObject()->method(word("method")) : nullptr;
  if (!method) return std::string(request);
  const std::string mark = fmt::format(": {}", Convert<Secret>::kName);
  bool any = false;
  for (std::size_t i = 0; i < method->parameters.size(); ++i) {
    if (!method->parameters[i].ends_with(mark)) continue;
    any = true;
    if (Json& given = json["arguments"]; given.is_array() && i < given.size())
      given[i] = "";
    else if (!given.is_array())
      given = Json::array();
  }
  return any ? json.dump(-1, ' ', false, Json::error_handler_t::replace) : std::string(request);
}

IInputTape::Clock::time_point Recorder::time(Clock::time_point live) {
  using std::chrono::microseconds;
  const auto at = std::chrono::floor<microseconds>(live);  // what is below would be a quarter of the bytes
  put({.kind = Input::Kind::time, .number = at.time_since_epoch().count()});
  return at;
}

bool Recorder::decide(std::string_view what, std::uint64_t key, bool live, bool usual) {
  if (live != usual) put({.kind = Input::Kind::decision, .place = what, .key = key});
  return live;
}

void Recorder::endCycle(const Event& event) {
  if (!recording_ || failed_) return;
  // All that came in this cycle is known now; time is that of its end.
  const double end = simulation_ ? simulation_->time() : event.time;
  lastTime_ = recorder::nanoseconds(end);
  attachNewTexts(lastTime_);
  writeInputs(lastTime_);
  if (event.cycle % hashEvery_ == 0)
    recording_->message(hashChannel_, lastTime_,
                        fmt::format("{{\"cycle\":{},\"state\":\"{:016x}\"}}", event.cycle, stateHash(kernel().root())));
  if (end >= nextKeyFrame_ - 1e-9) {
    keyFrame(lastTime_);
    nextKeyFrame_ += every_;
  }
  drawFrame(lastTime_);
  if (match_ && monitor_) match_->take(*monitor_, event.cycle, end, structure_ == kernel().structureVersion());
  if (const std::string why = recording_->failure(); !why.empty()) {
    failed_ = true;
    kernel().log().error("{}: the recording {} ends at {:.2f} s: {}", path(), file_, end, why);
  }
}

void Recorder::writeInputs(mcap::Time time) {
  const auto batch = std::make_shared<recorder::InputBatch>(std::exchange(inputs_, inputs_.next()));
  recording_->later(batch->bytes(), [writer = inputWriter_, batch, time, channel = inputChannel_,
                                     restarts = std::exchange(inputsRestart_, false)](const auto& put) {
    if (restarts) writer->restart();
    for (const std::string& piece : writer->write(batch->inputs())) put(channel, time, piece);
  });
}

/// A simulation may begin here, without the inputs before.
void Recorder::keyFrame(mcap::Time time) {
  inputsRestart_ = true;
  const auto state = std::make_shared<Snapshot>();
  state->state.reserve(stateBytes_);
  snapshots_->take(*state);
  stateCycle_ = state->cycle;
  stateBytes_ = state->state.size();
  recording_->later(stateBytes_ + state->shape->memory(), [channel = stateChannel_, state, time](const auto& put) {
    put(channel, time, recorder::snapshotBytes(*state));
  });
}

void Recorder::drawFrame(mcap::Time time) {
  if (!frames_ || static_cast<double>(time) * 1e-9 < nextPicture_ - 1e-9) return;
  nextPicture_ += picture_;
  if (frames_->refresh()) recording_->message(shapeChannel_, time, frames_->shapes(time));
  const auto places = std::make_shared<const recorder::Places>(frames_->places());
  recording_->later(places->worlds.size() * sizeof(Matrix), [places, time, channel = placeChannel_](const auto& put) {
    put(channel, time, places->message(time));
  });
}

/// Files may be read later as well, such as a robot's when an agent joins.
void Recorder::attachNewTexts(mcap::Time time) {
  const Sources& sources = kernel().sources();
  if (sources.all().size() == attached_.size()) return;
  for (const Sources::Source& s : sources.all())
    if (const std::string* text = sources.text(s.hash); attached_.insert(s).second && text)
      recording_->attachment(time, recorder::attachmentName(s), std::string(recorder::kAttachmentType), *text);
}

}  // namespace spark
