#include "player.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <optional>

#include "api/control.h"
#include "api/monitor.h"
#include "difference.h"
#include "spark/error.h"
#include "spark/state.h"

namespace spark {

using recorder::OwnInput;

namespace {
constexpr std::string_view kNames[] = {"a cycle",   "the wall clock", "a connection", "a message",
                                       "a leaving", "a request",      "a command",    "a decision"};
std::string_view nameOf(Input::Kind kind) { return kNames[static_cast<std::size_t>(kind)]; }

constexpr std::size_t kMostUnfinished = 512u << 20;  // bytes of inputs of one cycle; a recorder queues fewer
constexpr std::size_t kMostAtOnce = 128u << 20;      // bytes of inputs of one time

/// True for what play() passes on; all else is asked for.
bool isPassed(Input::Kind kind) {
  return kind != Input::Kind::cycle && kind != Input::Kind::time && kind != Input::Kind::decision;
}
}  // namespace

/// A client of the recorded run. What is sent to it is lost.
class InputPlayer::Connection : public IConnection {
 public:
  Connection(Node& port, std::uint64_t id, std::string peer) : port_(&port), id_(id), peer_(std::move(peer)) {}
  std::uint64_t id() const override { return id_; }
  const std::string& peer() const override { return peer_; }
  Node& port() override {
    if (Node* node = port_.get()) return *node;
    throw Error(fmt::format("the port of {} is gone", peer_));
  }
  bool send(std::string_view) override { return true; }
  bool idle() const override { return true; }
  double stalledSeconds() const override { return 0; }
  void close(std::string_view) override {}

 private:
  Ref<Node> port_;
  std::uint64_t id_;
  std::string peer_;
};

void InputPlayer::describe(Description<InputPlayer>& d) {
  d.doc("Plays a recording: passes its inputs on, and compares hashes and states.");
  d.implements<IInputTape>();
  d.link(&InputPlayer::simulation_, At<ISimulation>());
  d.link(&InputPlayer::snapshots_, At<ISnapshots>());
  d.property("file", &InputPlayer::file_).readOnly().ofProcess().doc("The recording.");
  d.property("cycles", &InputPlayer::cycles_).readOnly().ofProcess().unit("1").doc("Cycles that were played.");
  d.property("compared", &InputPlayer::compared_).readOnly().ofProcess().unit("1").doc("Hashes that were compared.");
  d.property("states", &InputPlayer::states_)
      .readOnly()
      .ofProcess()
      .unit("1")
      .doc("States that were compared as a whole.");
  d.property("differsAt", &InputPlayer::differsAt_)
      .readOnly()
      .ofProcess()
      .unit("1")
      .doc("The first cycle whose state is another one than in the recording; -1: none is.");
  d.property("difference", &InputPlayer::difference_)
      .readOnly()
      .ofProcess()
      .doc("What differs: the node and the property; empty: nothing, or not known yet.");
  d.property("lacks", &InputPlayer::lacks).ofProcess().doc("What is missing in the recording.");
  d.method("open", &InputPlayer::open).parameters({"file"}).doc("Opens a recording.");
  d.method("seek", &InputPlayer::seek)
      .parameters({"time [s]"})
      .doc("Goes to the newest recorded state that is not later than a simulated time.");
  d.on<&InputPlayer::endCycle>(phase::kPublish);
}

InputPlayer::InputPlayer() = default;
InputPlayer::~InputPlayer() = default;

void InputPlayer::onUnlink() {
  // Consumers keep pointers to connections until these are disconnected.
  for (const auto& [at, connection] : connections_) {
    const Leaf* const port = connection ? kernel().root().find(at.first) : nullptr;
    if (IConnectionConsumer* const consumer = port ? consumerOf(*port) : nullptr) consumer->disconnected(*connection);
  }
  connections_.clear();
}

std::vector<std::string> InputPlayer::lacks() const {
  std::vector<std::string> out = reader_ ? reader_->lacks() : std::vector<std::string>();
  out.insert(out.end(), holes_.begin(), holes_.end());
  return out;
}

void InputPlayer::open(std::string file) {
  reader_ = std::make_unique<mcap::Reader>(file);
  file_ = std::move(file);
  recorder::channelOf(*reader_, recorder::kStates, recorder::kStatesEncoding);
  if (recorder::channelOf(*reader_, recorder::kInputs, recorder::kInputsEncoding) == 0)
    throw Error(fmt::format("{} is no recording of Spark: it has no channel {}", file_, recorder::kInputs));
  fill();
  cycle_ = simulation_ ? simulation_->cycle() : 0;
  if (frames_.empty()) return;
  if (StateReader(frames_.begin()->second).readInteger() == cycle_)
    compareState(frames_.begin()->second);
  else
    seek(static_cast<double>(frames_.begin()->first) * 1e-9);  // it began in the middle of a run
}

mcap::Time InputPlayer::timeNow() const { return recorder::nanoseconds(simulation_ ? simulation_->time() : 0); }

void InputPlayer::seek(double seconds) {
  if (!snapshots_) throw Error(fmt::format("{}: expected a node {}", path(), ISnapshots::kPath));
  const auto at = recorder::stateBefore(*reader_, seconds);
  if (!at) throw Error(fmt::format("{} has no state up to {} s", file_, seconds));
  goTo(*at);
}

void InputPlayer::goTo(recorder::StateAt at) {
  std::string state;
  const std::uint16_t states = reader_->channelOf(recorder::kStates);
  reader_->forEach(reader_->chunks()[at.chunk], [&](const mcap::Message& m) {
    if (m.channel == states && m.time == at.time) state = m.data;
    return state.empty();
  });
  recorder::addTexts(*reader_, at.time, kernel().sources());
  const Snapshot snapshot = snapshots_->read(state);
  inputs_.clear();
  pieces_.clear();
  hashes_.clear();
  frames_.clear();
  cyclesAhead_ = 0;
  unfinished_ = 0;
  inputReader_.restart();
  hole_ = true;  // if it cannot be restored
  snapshots_->restore(snapshot, {});
  hole_ = false;
  chunk_ = at.chunk;
  cycle_ = from_ = snapshot.cycle;
  ++states_;
  after_ = at.time;  // what came before belongs to earlier cycles
  readChunk();
  fill();
}

/// Goes on from the next state after a damaged chunk; false if there is none.
bool InputPlayer::skipHole() {
  const std::uint16_t states = reader_->channelOf(recorder::kStates);
  const std::size_t chunk = chunk_ > 0 ? chunk_ - 1 : 0;
  const std::int64_t last = cycle_;
  for (mcap::Time before = std::max(timeNow(), after_); snapshots_;) {
    std::optional<recorder::StateAt> next;
    for (std::size_t i = chunk; i < reader_->chunks().size() && !next; ++i)
      reader_->forEach(reader_->chunks()[i], [&](const mcap::Message& m) {
        if (m.channel == states && m.time > before) next = {i, m.time};
        return !next;
      });
    if (!next) return false;
    before = next->time;
    try {
      goTo(*next);
    } catch (const Error& e) {
      holes_.push_back(fmt::format("the state at {:.3f} s: {}", static_cast<double>(before) * 1e-9, e.what()));
      continue;
    }
    holes_.push_back(
        cycle_ > last ? fmt::format("cycles {} to {}, after which it goes on from a recorded state", last + 1, cycle_)
                      : fmt::format("inputs behind cycle {}", last));
    kernel().log().warning("{}: the recording lacks {}", path(), holes_.back());
    return true;
  }
  return false;
}

/// Reads the next chunk; false if there is none.
bool InputPlayer::readChunk() {
  if (!reader_ || hole_ || chunk_ >= reader_->chunks().size()) return false;
  const std::uint16_t inputs = reader_->channelOf(recorder::kInputs), hashes = reader_->channelOf(recorder::kHashes),
                      states = reader_->channelOf(recorder::kStates);
  hole_ = !reader_->forEach(reader_->chunks()[chunk_++], [&](const mcap::Message& m) {
    if (m.time <= after_ && m.channel != states) return true;
    if (m.channel == inputs) {
      pieces_.emplace_back(m.time, m.data);
    } else if (m.channel == hashes) {
      const auto j = nlohmann::json::parse(m.data, nullptr, false);
      if (j.is_object() && j.contains("cycle") && j["cycle"].is_number_integer() && j.contains("state") &&
          j["state"].is_string())
        hashes_[j["cycle"].get<std::int64_t>()] = j["state"].get<std::string>();
    } else if (m.channel == states) {
      frames_[m.time] = m.data;
    }
    return true;
  });
  return true;
}

/// Decodes the next pieces of inputs, those of one cycle; false if there are none. What is damaged is the end of what
/// can be read.
bool InputPlayer::readPieces() {
  if (pieces_.empty()) return false;
  std::vector<OwnInput> read;
  std::size_t counted = 0, unfinished = unfinished_, sum = 0;
  try {
    for (const mcap::Time time = pieces_.front().first; !pieces_.empty() && pieces_.front().first == time;) {
      inputReader_.read(pieces_.front().second, read);
      pieces_.pop_front();
      for (; counted < read.size(); ++counted) {
        sum += read[counted].bytes();
        unfinished = read[counted].kind == Input::Kind::cycle ? 0 : unfinished + read[counted].bytes();
      }
      if (sum > kMostAtOnce) throw Error(fmt::format("one time has more than {} MB of inputs", kMostAtOnce >> 20));
      if (unfinished > kMostUnfinished)
        throw Error(fmt::format("a cycle has more than {} MB of inputs", kMostUnfinished >> 20));
    }
  } catch (const Error& e) {
    hole_ = true;
    pieces_.clear();
    holes_.push_back(fmt::format("what follows cycle {}: {}", cycle_, e.what()));
    return false;
  }
  unfinished_ = unfinished;
  for (OwnInput& in : read) {
    cyclesAhead_ += in.kind == Input::Kind::cycle;
    inputs_.push_back(std::move(in));
  }
  return true;
}

/// Reads until a whole cycle is known, with its hash and state: until the next one has begun.
void InputPlayer::fill() {
  while (cyclesAhead_ < 2 && (readPieces() || readChunk())) continue;
}

/// What comes next on the tape; nullptr at its end.
const OwnInput* InputPlayer::next() {
  if (inputs_.empty()) fill();
  return inputs_.empty() ? nullptr : &inputs_.front();
}

/// The simulation asks for something else than what is recorded.
void InputPlayer::lost(std::string_view asked) {
  if (std::exchange(lost_, true)) return;
  const OwnInput* const found = next();
  if (!found && !lacks().empty())
    kernel().log().warning("{}: the recording lacks what follows cycle {}", path(), cycle_);
  else
    differs(cycle_, fmt::format("the simulation asks for {}, the recording has {}", asked,
                                found ? nameOf(found->kind) : "ended"));
  if (simulation_) simulation_->stop();
}

void InputPlayer::play() {
  bool any = passInputs();
  if (!next() && hole_ && skipHole()) any = passInputs() || any;
  constexpr int kMostIdlePlays = 100;
  if (any) idlePlays_ = 0;
  if (!next()) {
    if (!frames_.empty()) compareState(frames_.rbegin()->second);  // that of the end
    frames_.clear();
    if (simulation_) simulation_->stop();
  } else if (++idlePlays_ > kMostIdlePlays) {
    lost("more inputs before the next cycle");
  }
}

/// Passes on what comes before the next decision or cycle. False if there is nothing.
bool InputPlayer::passInputs() {
  bool any = false;
  while (const OwnInput* const in = next()) {
    if (!isPassed(in->kind)) break;
    const OwnInput input = std::move(inputs_.front());
    inputs_.pop_front();
    pass(input);
    any = true;
  }
  return any;
}

/// Who gets the messages of a port: the port itself, if it takes them, else the node that its property names.
IConnectionConsumer* InputPlayer::consumerOf(const Leaf& port) const {
  if (const auto self = port.as<IConnectionConsumer>()) return self.object;
  Leaf* const node = kernel().root().find(getProperty(port, "consumer").plain());
  return node ? node->as<IConnectionConsumer>().object : nullptr;
}

void InputPlayer::pass(const OwnInput& input) {
  passing_ = true;
  try {
    switch (input.kind) {
      case Input::Kind::connect:
      case Input::Kind::message:
      case Input::Kind::leave: {
        Node& port = kernel().root().require<Node>(input.place);
        auto& connection = connections_[{input.place, input.key}];
        auto* const consumer = consumerOf(port);
        if (input.kind == Input::Kind::connect) {
          if (connection && consumer) consumer->disconnected(*connection);  // of an earlier run
          connection = std::make_unique<Connection>(port, input.key, input.text);
        }
        if (!connection) {
          // It connected before the state from which the run goes on.
          if (from_ == 0) throw Error(fmt::format("{} of a client that never connected", nameOf(input.kind)));
          connection = std::make_unique<Connection>(port, input.key, fmt::format("client {}", input.key));
          if (consumer) consumer->connected(*connection);
        }
        if (consumer) {
          if (input.kind == Input::Kind::connect) consumer->connected(*connection);
          if (input.kind == Input::Kind::message) consumer->received(*connection, input.text);
          if (input.kind == Input::Kind::leave) consumer->disconnected(*connection);
        }
        if (input.kind == Input::Kind::leave) connections_.erase({input.place, input.key});
        break;
      }
      case Input::Kind::request: {
        control::Watch watch;
        kernel().root().require<IRequests>().answer(input.text, watch, true);
        break;
      }
      case Input::Kind::command:
        kernel().root().require<IMonitorServer>().command(input.place, input.text);
        break;
      default:
        break;
    }
  } catch (const std::exception& e) {
    kernel().log().error("{}: cannot pass {} on: {}", path(), nameOf(input.kind), e.what());
  }
  passing_ = false;
}

IConnection* InputPlayer::connection(Node& port, std::uint64_t key) {
  auto& client = connections_[{port.path(), key}];
  if (!client) client = std::make_unique<Connection>(port, key, fmt::format("client {}", key));
  return client.get();
}

bool InputPlayer::put(const Input& input) {
  if (input.kind != Input::Kind::cycle) return passing_;
  idlePlays_ = 0;
  const OwnInput* const in = next();
  if (!in || in->kind != Input::Kind::cycle || in->number != input.number)
    lost(fmt::format("cycle {}", input.number));
  else
    inputs_.pop_front(), --cyclesAhead_;
  cycle_ = input.number;
  return true;
}

IInputTape::Clock::time_point InputPlayer::time(Clock::time_point live) {
  const OwnInput* const in = next();
  if (!in || in->kind != Input::Kind::time) {
    lost(nameOf(Input::Kind::time));
    return live;
  }
  const std::chrono::microseconds at(in->number);
  inputs_.pop_front();
  idlePlays_ = 0;
  return Clock::time_point(std::chrono::duration_cast<Clock::duration>(at));
}

bool InputPlayer::decide(std::string_view what, std::uint64_t key, bool, bool usual) {
  const OwnInput* const in = next();
  if (!in || in->kind != Input::Kind::decision || in->place != what || in->key != key) return usual;
  inputs_.pop_front();
  return !usual;
}

void InputPlayer::differs(std::int64_t cycle, std::string what) {
  if (differsAt_ < 0) {
    differsAt_ = cycle;
    kernel().log().error("{}: cycle {} differs from the recording{}{}", path(), cycle, what.empty() ? "" : ": ", what);
  }
  if (difference_.empty()) difference_ = std::move(what);
}

void InputPlayer::compareState(std::string_view frame) {
  StateReader in(frame);
  const std::int64_t cycle = in.readInteger();
  const auto configuration = static_cast<std::uint64_t>(in.readInteger());
  const std::string state = in.readString();
  ++states_;
  if (std::string found = recorder::firstDifference(kernel().root(), state); !found.empty())
    differs(cycle, std::move(found));
  else if (configuration != configurationHash(kernel().root()))
    differs(cycle, "the configuration, or a file that it was made of");
}

void InputPlayer::endCycle(const Event& event) {
  if (lost_) return;  // this cycle lacks its inputs
  ++cycles_;
  fill();
  if (const auto found = hashes_.find(event.cycle); found != hashes_.end()) {
    ++compared_;
    if (found->second != fmt::format("{:016x}", stateHash(kernel().root()))) differs(event.cycle, {});
  }
  const mcap::Time now = timeNow();
  if (const auto found = frames_.find(now); found != frames_.end()) compareState(found->second);
  hashes_.erase(hashes_.begin(), hashes_.upper_bound(event.cycle));
  frames_.erase(frames_.begin(), frames_.upper_bound(now));
}

}  // namespace spark
