#include "player.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

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
  d.property("file", &InputPlayer::file_).readOnly().ofProcess().doc("The recording.");
  d.property("compared", &InputPlayer::compared_)
      .readOnly()
      .ofProcess()
      .unit("1")
      .doc("Cycles whose hash was compared.");
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

std::vector<std::string> InputPlayer::lacks() const { return reader_ ? reader_->lacks() : std::vector<std::string>(); }

void InputPlayer::open(std::string file) {
  reader_ = std::make_unique<mcap::Reader>(file);
  file_ = std::move(file);
  if (reader_->channelOf(recorder::kInputs) == 0)
    throw Error(fmt::format("{} is no recording of Spark: it has no channel {}", file_, recorder::kInputs));
  fill();
  cycle_ = simulation_ ? simulation_->cycle() : 0;
  if (const auto first = frames_.find(cycle_); first != frames_.end()) compareState(first->second, cycle_);
}

/// Reads the next chunk; false if there is none.
bool InputPlayer::readChunk() {
  if (!reader_ || chunk_ >= reader_->chunks().size()) return false;
  const std::uint16_t inputs = reader_->channelOf(recorder::kInputs), hashes = reader_->channelOf(recorder::kHashes),
                      states = reader_->channelOf(recorder::kStates);
  reader_->forEach(reader_->chunks()[chunk_++], [&](const mcap::Message& m) {
    if (m.channel == inputs) {
      std::vector<OwnInput> read;
      recorder::readInputs(m.data, read);
      inputs_.insert(inputs_.end(), std::make_move_iterator(read.begin()), std::make_move_iterator(read.end()));
    } else if (m.channel == hashes) {
      const auto j = nlohmann::json::parse(m.data, nullptr, false);
      if (j.is_object() && j.contains("cycle") && j["cycle"].is_number_integer() && j.contains("state") &&
          j["state"].is_string())
        hashes_[j["cycle"].get<std::int64_t>()] = j["state"].get<std::string>();
    } else if (m.channel == states) {
      frames_[StateReader(m.data).readInteger()] = m.data;
    }
    return true;
  });
  return true;
}

/// Reads until a whole cycle is known, with its hash and state: until the next one has begun.
void InputPlayer::fill() {
  const auto begun = [this] {
    int cycles = 0;
    for (const OwnInput& i : inputs_)
      if (i.kind == Input::Kind::cycle && ++cycles == 2) return true;
    return false;
  };
  while (!begun() && readChunk()) continue;
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
  if (!reader_->lacks().empty())
    kernel().log().warning("{}: the recording lacks what follows cycle {}", path(), cycle_);
  else
    differs(cycle_, fmt::format("the simulation asks for {}, the recording has {}", asked,
                                found ? nameOf(found->kind) : "ended"));
  if (simulation_) simulation_->stop();
}

void InputPlayer::play() {
  bool any = false;
  while (const OwnInput* const in = next()) {
    if (!isPassed(in->kind)) break;
    const OwnInput input = std::move(inputs_.front());
    inputs_.pop_front();
    pass(input);
    any = true;
  }
  constexpr int kMostIdlePlays = 100;
  if (any) idlePlays_ = 0;
  if (!next()) {
    if (simulation_) simulation_->stop();
  } else if (++idlePlays_ > kMostIdlePlays) {
    lost("more inputs before the next cycle");
  }
}

IConnectionConsumer* InputPlayer::consumerOf(const Leaf& port) const {
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
        if (input.kind == Input::Kind::connect) connection = std::make_unique<Connection>(port, input.key, input.text);
        if (!connection) throw Error(fmt::format("{} of a client that never connected", nameOf(input.kind)));
        if (auto* const consumer = consumerOf(port)) {
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

bool InputPlayer::put(const Input& input) {
  if (input.kind != Input::Kind::cycle) return passing_;
  idlePlays_ = 0;
  const OwnInput* const in = next();
  if (!in || in->kind != Input::Kind::cycle || in->number != input.number)
    lost(fmt::format("cycle {}", input.number));
  else
    inputs_.pop_front();
  cycle_ = input.number;
  return true;
}

IInputTape::Clock::time_point InputPlayer::time(Clock::time_point live) {
  const OwnInput* const in = next();
  if (!in || in->kind != Input::Kind::time) {
    lost(nameOf(Input::Kind::time));
    return live;
  }
  const std::chrono::nanoseconds at(in->number);
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

void InputPlayer::compareState(std::string_view frame, std::int64_t cycle) {
  StateReader in(frame);
  in.readInteger();
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
  fill();
  if (const auto found = hashes_.find(event.cycle); found != hashes_.end()) {
    ++compared_;
    if (found->second != fmt::format("{:016x}", stateHash(kernel().root()))) differs(event.cycle, {});
  }
  if (const auto found = frames_.find(event.cycle); found != frames_.end()) compareState(found->second, event.cycle);
  hashes_.erase(hashes_.begin(), hashes_.upper_bound(event.cycle));
  frames_.erase(frames_.begin(), frames_.upper_bound(event.cycle));
}

}  // namespace spark
